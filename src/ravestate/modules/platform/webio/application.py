"""The chat page as an ASGI application: its files, its WebSocket, and the access check."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import AsyncGenerator, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, cast

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
from .pages import Pages, refuse
from .sessions import Sessions

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .names import Settings

PAGE = Path(__file__).parent / "page"
"""The folder of the built page: the output of ``npm run build`` in ``frontend/``."""

MOST_LOGGED = 100
"""The log names at most this many sites that try to embed the page, each only once. So strangers cannot fill the log."""

log = logging.getLogger("ravestate.webio")


def make_app(agent: Agent, routes: Iterable[BaseRoute] = (), inside: str | None = None) -> Starlette:
    """Return the application of `webio.app`, with ``app.state.sessions`` and ``app.state.access``.

    For the arguments and errors, see `webio.app`.
    """
    settings = settings_of(agent)
    access = Access(settings)
    sessions = Sessions(agent, limit=settings.sessions, keep=settings.keep)

    async def connect(socket: WebSocket) -> None:
        title, suggestions = settings.title, settings.suggestions
        texts = settings.note, settings.privacy
        await Connection(socket, sessions, access, title, inside, suggestions, *texts).run()

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


def settings_of(agent: Agent) -> Settings:
    """Return the settings of webio in an agent.

    Raises:
        PlatformError: The agent lacks `webio`, or has `conio`.
    """
    names = [module.name for module in agent.policy.modules]
    if "webio" not in names:
        raise PlatformError(f"the agent has no webio: write Agent(webio, ...); it has {', '.join(names)}")
    if "conio" in names:  # the context of each visitor would contain conio
        raise PlatformError("webio has many users, conio has one: leave conio out")
    return cast("Settings", agent.settings["webio"])


class AccessMiddleware:
    """Middleware that refuses requests that fail the access check, and adds headers that restrict scripts and frames.

    The log names sites that try to embed the page without permission, because their visitors see only an empty frame.
    One instance guards the whole application. A second one, with `inside=True`, guards the board
    (Raveboard), which only the page's own site may reach.
    """

    def __init__(self, app: ASGIApp, *, inside: bool = False) -> None:
        self._app = app
        self._inside = inside
        self._embedders: set[str] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse a request, or pass it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        access: Access = scope["app"].state.access
        headers = Headers(scope=scope)
        refusal = access.refusal_of_board(headers) if self._inside else access.refusal(headers)
        if scope["type"] == "websocket":
            if refusal is not None:
                await refuse(WebSocket(scope, receive, send), PlainTextResponse(refusal, 403))
            else:
                await self._app(scope, receive, send)
            return

        if not self._inside:
            self._log_embedder(access.foreign_embedder(headers))

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                answered = MutableHeaders(scope=message)
                sessions: Sessions = scope["app"].state.sessions
                devices = [] if self._inside else _devices(sessions)
                for name, value in _bounds(() if self._inside else access.origins, devices).items():
                    answered.setdefault(name, value)  # the board's own header is stricter, so it stays
            await send(message)

        answer = self._app if refusal is None else PlainTextResponse(refusal, 403)
        await answer(scope, receive, with_headers)

    def _log_embedder(self, origin: str | None) -> None:
        if origin is not None and origin not in self._embedders and len(self._embedders) < MOST_LOGGED:
            self._embedders.add(origin)
            log.warning("a page of %s may not embed the chat: add it to the setting webio.origins", origin)


def _devices(sessions: Sessions) -> list[str]:
    """Return the devices that the page of an agent may use."""
    return ["microphone"] * sessions.hears + ["camera"] * sessions.sees


def _bounds(framing: Iterable[str], devices: Iterable[str]) -> dict[str, str]:
    """Return headers that restrict scripts. Only the page's own site and the origins in `framing` may embed the page.

    The headers let the page use the microphone and the camera only if these are among the `devices`.
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
        "permissions-policy": ", ".join(
            f"{name}=({'self' if name in devices else ''})" for name in ("camera", "geolocation", "microphone")
        ),
        "referrer-policy": "no-referrer",
        "x-content-type-options": "nosniff",
    }
