"""A page to talk on: each visitor has a conversation of their own with the agent."""

from __future__ import annotations

import asyncio
import importlib
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated

import pydantic

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio

if TYPE_CHECKING:
    from starlette.applications import Starlette
    from starlette.routing import BaseRoute

    from ravestate.runtime.agent import Agent

    from .session import Session

__all__ = ["Settings", "app", "module", "page", "rules", "serve"]

ORIGIN = re.compile(r"https?://[^\s/?#@'\";,*]+")
"""Which site a page is of."""


def _origin(text: str) -> str:
    if ORIGIN.fullmatch(text) is None:
        raise ValueError("write an origin, e.g. https://museum.example")
    return text.lower()


class Settings(rs.Settings):
    """Where the page is, who may see it, and how much it bears."""

    host: str = "127.0.0.1"
    """The address to listen on. Any other than this machine's own needs a token."""
    port: int = pydantic.Field(8420, ge=0, le=65535)
    """The port; 0 takes any that is free."""
    token: pydantic.SecretStr | None = None
    """What a visitor must present, as a link with ``#token=...`` does; best given as ``RAVESTATE_WEBIO_TOKEN``."""
    origins: tuple[Annotated[str, pydantic.AfterValidator(_origin)], ...] = ()
    """Web sites that may embed the page, e.g. ``https://museum.example``; also the page's own, behind a proxy."""
    title: str | None = None
    """What the agent is called on the page, by default ``interloc.agent``."""
    keep: float = pydantic.Field(600.0, ge=0, allow_inf_nan=False)
    """Seconds for which a conversation is kept when its visitor is gone."""
    sessions: int = pydantic.Field(1000, ge=1)
    """Conversations at one time."""
    per_address: int = pydantic.Field(100, ge=1)
    """Connections at one time from one address."""

    @pydantic.field_validator("token")
    @classmethod
    def _long_enough(cls, token: pydantic.SecretStr | None) -> pydantic.SecretStr | None:
        if token is not None and len(token.get_secret_value()) < 12:
            raise ValueError("write at least 12 characters, such as secrets.token_urlsafe() makes")
        return token


async def serve(agent: Agent) -> None:
    """Serve an agent on a page of its own, with the settings of ``webio``, until this is cancelled.

    Raises:
        PlatformError: The port is in use, a token is missing, or starlette or uvicorn is not installed.
    """
    await asyncio.to_thread(_load)  # a quarter of a second; others may be at work
    from .server import Server

    async with Server(agent) as server:
        server.announce()
        await server.until_failed()


def app(agent: Agent, routes: Iterable[BaseRoute] = (), inside: str | None = None) -> Starlette:
    """The page of an agent as an ASGI application, to be served, or mounted in another one.

    Its lifespan ends the conversations in order. A mounted one has none of its own: enter
    ``chat.router.lifespan_context(chat)`` in that of the whole. How many connections there may be is then for the
    server to say.

    Args:
        agent: The agent, with ``webio`` among its modules.
        routes: Served beside the page, behind the same checks of host and origin.
        inside: Where among them the page may look inside of the agent, e.g. ``board/``.

    Raises:
        PlatformError: Starlette is not installed.

    Example:
        ```python
        from ravestate.runtime.agent import Agent

        chat = webio.app(Agent(webio, my_module))
        ```
    """
    _load()
    from .application import make_app

    return make_app(agent, routes, inside)


def _load() -> None:
    for name in ("starlette.applications", "uvicorn", "websockets"):
        try:
            importlib.import_module(name)
        except ImportError as error:
            raise PlatformError(f"webio needs {error.name}: pip install 'ravestate[web]'") from error


module = rs.Module("webio", requires=(rawio, interloc), settings=Settings, serve=serve)

page: rs.Slot[Session | None] = module.slot("page", None)
"""The conversation on the page that this context is for; None where somebody else runs it."""

from . import rules  # noqa: E402  # it adds the rules to the module
