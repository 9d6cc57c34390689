"""The webhook: a small web server that Telegram sends updates to."""

from __future__ import annotations

import hmac
import json
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

if TYPE_CHECKING:
    from telegram import Bot

    from .names import Settings

LARGEST = 1024 * 1024
"""The maximum number of bytes of an update."""


async def listen(
    bot: Bot,
    settings: Settings,
    secret: str,
    kinds: Sequence[str],
    take: Callable[[Sequence[Mapping[str, Any]]], None],
) -> None:
    """Take the updates that the server sends, until cancelled. The server shows the secret with each update.

    An update is acknowledged after `take` has kept it. The webhook stays set, so that no update is lost meanwhile.
    """

    async def update(request: Request) -> Response:
        shown = request.headers.get("x-telegram-bot-api-secret-token", "")
        if not hmac.compare_digest(shown.encode(), secret.encode()):
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
        if isinstance(found, dict):
            take([found])
        return Response()

    assert settings.webhook is not None  # the caller has checked it
    app = Starlette(routes=[Route(urlsplit(settings.webhook).path or "/", update, methods=["POST"])])
    config = uvicorn.Config(
        app, host=settings.host, port=settings.port, log_config=None, access_log=False, server_header=False
    )
    server = uvicorn.Server(config)
    server.install_signal_handlers = lambda: None  # the agent has its own
    await bot.set_webhook(settings.webhook, secret_token=secret, allowed_updates=list(kinds))
    await server._serve()  # pyright: ignore[reportPrivateUsage]  # `serve` would take over the process's signals
