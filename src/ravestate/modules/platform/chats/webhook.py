"""A webhook: a small web server to which a messenger sends its messages."""

from __future__ import annotations

import asyncio
import contextlib
import hmac
import json
import logging
import socket
import sqlite3
from collections.abc import Awaitable, Callable, Generator
from typing import Any
from urllib.parse import urlsplit

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from ravestate.errors import PlatformError

log = logging.getLogger("ravestate.chats")

LARGEST = 1024 * 1024
"""The maximum size of a request in bytes."""


async def listen(
    url: str,
    address: tuple[str, int],
    header: str,
    secret: str,
    take: Callable[[Any], None],
    announce: Callable[[], Awaitable[object]],
) -> None:
    """Receive the requests of a messenger until cancelled. The server acknowledges a request after `take` has returned.

    Args:
        url: The public address of the webhook. The server uses only the path of this address.
        address: The host and the port to listen on.
        header: The name of the header in which the messenger sends the secret.
        secret: The secret. The server refuses a request without it.
        take: A function to call with the parsed JSON of each request. If it raises a `sqlite3.Error`, the server answers
            with status 503, so that the messenger sends the request again.
        announce: A function to call as soon as the server listens.

    Raises:
        PlatformError: The server cannot listen on the address, for example because the port is in use.
    """

    async def post(request: Request) -> Response:
        if not hmac.compare_digest(request.headers.get(header, "").encode(), secret.encode()):
            return Response(status_code=403)
        body = b""
        async for block in request.stream():
            body += block
            if len(body) > LARGEST:
                return Response(status_code=413)
        try:
            found = json.loads(body)
        except ValueError:
            return Response(status_code=400)
        try:
            take(found)
        except sqlite3.Error as error:  # the messenger sends the request again
            log.warning("a request is not kept: %s", error)
            return Response(status_code=503)
        return Response()

    host, port = address[0].strip("[]"), address[1]
    try:
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        listener = socket.create_server((host, port), family=family)
    except OSError as error:
        raise PlatformError(f"the webhook cannot listen on {host}, port {port}: {error.strerror}") from None
    app = Starlette(routes=[Route(urlsplit(url).path or "/", post, methods=["POST"])])
    server = _Server(uvicorn.Config(app, log_config=None, access_log=False, server_header=False, lifespan="off"))
    serving = asyncio.create_task(server.serve(sockets=[listener]))
    try:
        await announce()
        await asyncio.shield(serving)
    finally:
        server.should_exit = server.force_exit = True
        await serving


class _Server(uvicorn.Server):
    """A uvicorn server without signal handlers, because the agent's runner has its own handlers."""

    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        """Leave the signal handlers as they are."""
        yield
