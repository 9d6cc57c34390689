"""The two ways to serve an agent's page: alone, or mounted in another ASGI application."""

from __future__ import annotations

import asyncio
import importlib
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ravestate.errors import PlatformError

from .names import module

if TYPE_CHECKING:
    from starlette.applications import Starlette
    from starlette.routing import BaseRoute

    from ravestate.runtime.agent import Agent


@module.server
async def serve(agent: Agent) -> None:
    """Serve an agent's page with the settings of ``webio`` until the task is cancelled.

    Raises:
        PlatformError: The server cannot listen on the address, or a token is missing. Or starlette, uvicorn or websockets is
            not installed, or the agent has `conio`.
    """
    await asyncio.to_thread(_load)  # the imports take a quarter of a second, and would hold up other tasks
    from .server import Server

    async with Server(agent) as server:
        server.announce()
        await server.until_failed()


def app(agent: Agent, routes: Iterable[BaseRoute] = (), inside: str | None = None) -> Starlette:
    """Return an agent's page as an ASGI application, to serve alone or to mount in another application.

    The conversations end with the application's lifespan. A mounted application has no lifespan of its own. So enter
    ``chat.router.lifespan_context(chat)`` in the outer application's lifespan. Let the outer server limit connections.

    Args:
        agent: An agent with ``webio`` among its modules.
        routes: Further routes, protected by the same checks of host and origin as the page.
        inside: The path of the board (Raveboard) among those routes, e.g. ``board/``.

    Raises:
        PlatformError: starlette, uvicorn or websockets is not installed. Or the agent lacks `webio`, or has `conio`.

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
