"""Stand-ins for the model files, web servers and the hub that wildtalk finds on a machine and on the network."""

from __future__ import annotations

import contextlib
import hashlib
import struct
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from ravestate.modules.skill.wildtalk.model_store import CatalogueModel


def _text(text: str) -> bytes:
    return struct.pack("<Q", len(text.encode())) + text.encode()


def write_gguf(
    path: Path,
    parameters: int = 1_000_000_000,
    *,
    chats: bool = True,
    pools: bool = False,
    kind: str = "model",
    words: int = 50,
    size: int = 0,
) -> Path:
    """Write the header of a model with this many parameters, and `size` bytes in all (without weights by default)."""
    facts = [
        (b"".join((_text("general.architecture"), struct.pack("<I", 8), _text("qwen2")))),
        (b"".join((_text("general.type"), struct.pack("<I", 8), _text(kind)))),
        (b"".join((_text("qwen2.context_length"), struct.pack("<II", 4, 4096)))),
        (
            b"".join(
                (
                    _text("tokenizer.ggml.tokens"),
                    struct.pack("<IIQ", 9, 8, words),
                    *(_text(f"w{n}") for n in range(words)),
                )
            )
        ),
        (
            b"".join(
                (_text("tokenizer.ggml.token_type"), struct.pack("<IIQ", 9, 5, words), struct.pack("<i", 1) * words)
            )
        ),
    ]
    if chats:
        facts.append(b"".join((_text("tokenizer.chat_template"), struct.pack("<I", 8), _text("{{ messages }}"))))
    if pools:
        facts.append(b"".join((_text("qwen2.pooling_type"), struct.pack("<II", 4, 1))))
    tensors = [_text("a") + struct.pack("<IQQIQ", 2, 1000, parameters // 1000 - 1, 0, 0)]
    tensors.append(_text("b") + struct.pack("<IQIQ", 1, parameters - (parameters // 1000 - 1) * 1000, 0, 64))
    header = b"GGUF" + struct.pack("<IQQ", 3, len(tensors), len(facts)) + b"".join(facts + tensors)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.write(header.ljust(128, b"\0"))
        if size:
            file.truncate(size)
    return path


@contextlib.contextmanager
def serving(handler: type[BaseHTTPRequestHandler]) -> Iterator[int]:
    """Run a web server on a free port of the loopback interface; yield the port."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    try:
        yield server.server_port
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


class Quiet(BaseHTTPRequestHandler):
    """A handler that logs nothing."""

    def log_message(self, *_: Any) -> None:
        pass

    def reply(self, body: bytes, status: int = 200, **headers: str) -> None:
        self.send_response(status)
        for name, value in {"Content-Length": str(len(body)), **headers}.items():
            self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        self.wfile.write(body)


CONTENT = bytes(range(256)) * 2000
MODEL = CatalogueModel(
    name="tiny",
    repository="someone/tiny-GGUF",
    revision="0" * 40,
    file="tiny.gguf",
    size=len(CONTENT),
    sha256=hashlib.sha256(CONTENT).hexdigest(),
    parameters=1_000_000_000,
    licence="Apache-2.0",
    purpose="tests",
)
PATH = f"/{MODEL.repository}/resolve/{MODEL.revision}/{MODEL.file}"


class Hub:
    """A hub with one model. It redirects to a store of files. Each request uses the next entry of `script`.

    An entry is a status to answer with, or a pair of a status and the value of the header ``Retry-After``.
    ``("cut", n)`` breaks the connection after `n` bytes. ``"whole"`` ignores the requested range and sends the whole
    file. When no entry is left, the hub sends the requested range.
    """

    def __init__(self, content: bytes = CONTENT) -> None:
        self.content = content
        self.script: list[Any] = []
        self.requests: list[tuple[str, dict[str, str]]] = []
        self.url = ""

    @contextlib.contextmanager
    def running(self) -> Iterator[Hub]:
        hub = self

        class Store(Quiet):
            def do_GET(self) -> None:
                hub.requests.append((self.path, {name.lower(): value for name, value in self.headers.items()}))
                hub.send(self)

        class Front(Quiet):
            def do_GET(self) -> None:
                hub.requests.append((self.path, {name.lower(): value for name, value in self.headers.items()}))
                status, more = hub.refusal() if self.path == PATH else (404, {})
                if status == 302:
                    more = {"Location": f"http://localhost:{store}/blob"}
                self.reply(b"", status, **more)

        with serving(Store) as store, serving(Front) as front:
            self.url = f"http://127.0.0.1:{front}"
            yield self

    def refusal(self) -> tuple[int, dict[str, str]]:
        """Return the next status of the script, and its headers. The status is 302 if the file is to be sent."""
        entry = self.script[0] if self.script else None
        if isinstance(entry, tuple) and isinstance(entry[0], int):
            self.script.pop(0)
            return entry[0], {"Retry_After": str(entry[1])}
        return (self.script.pop(0), {}) if isinstance(entry, int) else (302, {})

    def send(self, request: Quiet) -> None:
        entry = self.script.pop(0) if self.script else None
        asked = request.headers.get("Range", "")
        start = 0 if entry == "whole" or not asked else int(asked.removeprefix("bytes=").removesuffix("-"))
        body = self.content[start:]
        request.send_response(206 if start else 200)
        request.send_header("Content-Length", str(len(body)))
        if start:
            request.send_header("Content-Range", f"bytes {start}-{len(self.content) - 1}/{len(self.content)}")
        request.end_headers()
        request.wfile.write(body[: entry[1]] if isinstance(entry, tuple) else body)
        request.close_connection = True
