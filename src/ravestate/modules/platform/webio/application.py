"""The page as an ASGI application: its files, its WebSocket, and what guards them."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import AsyncGenerator, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware import Middleware
from starlette.responses import PlainTextResponse
from starlette.routing import BaseRoute, Mount, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from ravestate.errors import PlatformError

from .access import Access
from .connection import Connection
from .pages import Pages
from .sessions import Sessions

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .names import Settings

__all__ = ["PAGE", "AccessMiddleware", "make_app"]

PAGE = Path(__file__).parent / "page"
"""What ``npm run build`` in ``frontend/`` makes."""

CONSOLES = ("conio",)
"""Platforms for one user, of which there would be one in each visitor's context."""

MOST_LOGGED = 100
"""Sites that the log names at most, each once: anybody could write into it."""

log = logging.getLogger("ravestate.webio")


def make_app(agent: Agent, routes: Iterable[BaseRoute] = (), inside: str | None = None) -> Starlette:
    """See `webio.app`. The conversations are in ``app.state.sessions``, the checks in ``app.state.access``.

    Raises:
        PlatformError: The agent lacks ``webio``, or has a platform that is for one user.
    """
    settings = _settings_of(agent)
    access = Access(settings)
    sessions = Sessions(agent, limit=settings.sessions, keep=settings.keep)

    async def connect(socket: WebSocket) -> None:
        title, suggestions = settings.title, settings.suggestions
        await Connection(socket, sessions, access, title, inside, suggestions).run()

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncGenerator[None]:
        try:
            yield
        finally:
            await sessions.close()

    app = Starlette(
        routes=[*routes, WebSocketRoute("/ws", connect), Mount("/", Pages(PAGE))],
        middleware=[Middleware(AccessMiddleware)],
        lifespan=lifespan,
    )
    app.state.sessions = sessions
    app.state.access = access
    return app


def _settings_of(agent: Agent) -> Settings:
    names = [module.name for module in agent.policy.modules]
    if "webio" not in names:
        raise PlatformError(f"the agent has no webio: write Agent(webio, ...); it has {', '.join(names)}")
    for name in CONSOLES:
        if name in names:
            raise PlatformError(f"webio has many users, {name} has one: leave {name} out")
    return agent.settings["webio"]  # type: ignore[return-value]  # the module's own


class AccessMiddleware:
    """Refuses requests that `Access` refuses, and sends headers with everything that keep scripts and frames in bounds.

    Sites whose pages may not show the chat are named in the log, as it is an empty frame that one sees there.

    One guards the whole application that `make_app` makes. A second one in it guards what looks inside of the agent: sites
    that may connect to the chat and show it may not do so there.

    Args:
        app: What is guarded.
        inside: Whether it looks inside of the agent.
    """

    def __init__(self, app: ASGIApp, *, inside: bool = False) -> None:
        self._app = app
        self._inside = inside
        self._embedders: set[str] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a request, and answer it or pass it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        access: Access = scope["app"].state.access
        headers = Headers(scope=scope)
        refusal = access.refusal_of_board(headers) if self._inside else access.refusal(headers)
        if scope["type"] == "websocket":
            if refusal is not None:
                await WebSocket(scope, receive, send).send_denial_response(PlainTextResponse(refusal, 403))
            else:
                await self._app(scope, receive, send)
            return

        if not self._inside:
            self._log_embedder(access.foreign_embedder(headers))

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                answered = MutableHeaders(scope=message)
                for name, value in _bounds(() if self._inside else access.origins).items():
                    answered.setdefault(
                        name, value
                    )  # unless the one for the inside, which is stricter, was here
            await send(message)

        answer = self._app if refusal is None else PlainTextResponse(refusal, 403)
        await answer(scope, receive, with_headers)

    def _log_embedder(self, origin: str | None) -> None:
        if origin is not None and origin not in self._embedders and len(self._embedders) < MOST_LOGGED:
            self._embedders.add(origin)
            log.warning("a page of %s wanted to show the chat: add it to the setting webio.origins", origin)


def _bounds(framing: Iterable[str]) -> dict[str, str]:
    """Headers that keep scripts and frames in bounds.

    Args:
        framing: Origins whose pages may show this one in a frame.
    """
    policy = (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data:",
        "font-src 'self'",
        "connect-src 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        " ".join(("frame-ancestors 'self'", *framing)),
    )
    return {
        "content-security-policy": "; ".join(policy),
        "permissions-policy": "camera=(), geolocation=(), microphone=()",
        "referrer-policy": "no-referrer",
        "x-content-type-options": "nosniff",
    }
