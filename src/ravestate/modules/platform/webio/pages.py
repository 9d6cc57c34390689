"""Serve the files of the built pages from memory, plain or compressed."""

from __future__ import annotations

import gzip
import hashlib
from pathlib import Path

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, Response
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

KINDS = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".woff2": "font/woff2",
}
COMPRESSED = {".woff2"}
"""The suffixes of files that are compressed already."""
LOGO = "assets/raven.svg"
"""The icon of all pages. Only the folder of the chat page has this file."""


async def refuse(socket: WebSocket, answer: Response) -> None:
    """Refuse a WebSocket's handshake with a response. Servers that lack the ASGI extension for it send status 403."""
    if "websocket.http.response" in (socket.scope.get("extensions") or {}):
        await socket.send_denial_response(answer)
    else:
        await socket.close()


class Pages:
    """An ASGI application that serves `LOGO`, the files of a folder, and ``index.html`` for the folder itself.

    It reads the files once, when it is created. It leaves out files whose suffixes are not in `KINDS`.
    """

    def __init__(self, folder: Path) -> None:
        self._files: dict[str, tuple[bytes, bytes | None, str, str]] = {}
        files = {LOGO: Path(__file__).parent / "page" / LOGO}
        files |= {file.relative_to(folder).as_posix(): file for file in folder.rglob("*")}
        for name, file in files.items():
            if file.suffix in KINDS:
                data = file.read_bytes()
                packed = None if file.suffix in COMPRESSED else gzip.compress(data, mtime=0)
                tag = f'"{hashlib.sha256(data).hexdigest()[:16]}"'
                self._files[f"/{name}"] = data, packed, KINDS[file.suffix], tag

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request for a file; refuse a WebSocket."""
        if scope["type"] == "websocket":
            await refuse(WebSocket(scope, receive, send), PlainTextResponse("there is no such WebSocket", 404))
        else:
            await self._answer(scope)(scope, receive, send)

    def _answer(self, scope: Scope) -> Response:
        if scope["method"] not in ("GET", "HEAD"):
            return PlainTextResponse("only GET", 405, {"allow": "GET, HEAD"})
        path = scope["path"].removeprefix(scope.get("root_path", "")) or "/"
        file = self._files.get(path + "index.html" if path.endswith("/") else path)
        if file is None:
            return PlainTextResponse("there is no such page", 404)
        data, packed, kind, tag = file
        asked = Headers(scope=scope)
        headers = {"cache-control": "no-cache", "etag": tag, "vary": "accept-encoding"}
        if asked.get("if-none-match") == tag:
            return Response(status_code=304, headers=headers)
        if packed is not None and "gzip" in asked.get("accept-encoding", ""):
            data, headers["content-encoding"] = packed, "gzip"
        return Response(data, headers=headers, media_type=kind)
