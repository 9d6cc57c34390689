"""The stand-in robot's page: it shows the robot, and lets a visitor talk to the robot."""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
from collections.abc import Generator
from pathlib import Path
from typing import Any, cast
from urllib.parse import urlsplit

import uvicorn
from starlette.applications import Starlette
from starlette.routing import Mount, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from ravestate.errors import PlatformError
from ravestate.modules.platform.webio.pages import Pages

from .stand_in import StandIn

PAGE = Path(__file__).with_name("page")
LONGEST = 4096
"""The robot hears at most this many characters of a message; the rest is cut off."""


class PageServer:
    """Serves the page of a stand-in robot on this machine: ``async with PageServer(robot) as server``.

    Args:
        robot: The stand-in.
        port: The port on the loopback interface; 0 takes a free one.

    Raises:
        PlatformError: The port is in use, or is not a port.
    """

    def __init__(self, robot: StandIn, port: int = 8421) -> None:
        self._robot = robot
        self._port = port
        self._sockets: set[WebSocket] = set()

    async def __aenter__(self) -> PageServer:
        app = Starlette(routes=[WebSocketRoute("/ws", self._talk), Mount("/", Pages(PAGE))])
        self._listener = socket.socket()
        self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._listener.bind(("127.0.0.1", self._port))
            self._listener.listen()  # from now on, a browser that connects before the server runs waits for it
        except (OSError, OverflowError) as error:
            self._listener.close()
            raise PlatformError(
                f"the robot's page cannot listen on port {self._port} ({error}): take any free port with --port 0"
            ) from error
        config = uvicorn.Config(
            app, lifespan="off", log_config=None, log_level="warning", access_log=False, ws_max_size=1 << 16,
            timeout_graceful_shutdown=1,
        )  # fmt: skip
        self._server = _Quiet(config)
        self._task = asyncio.create_task(self._server.serve(sockets=[self._listener]))
        return self

    async def __aexit__(self, *_: object) -> None:
        self._server.should_exit = True
        for websocket in list(self._sockets):
            with contextlib.suppress(Exception):
                await websocket.close(1001)
        await self._task
        self._listener.close()

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://127.0.0.1:{self._listener.getsockname()[1]}/"

    async def _talk(self, websocket: WebSocket) -> None:
        """Show the robot to a visitor, and pass on the visitor's words."""
        if not _is_own_page(websocket):
            await websocket.close(1008)
            return
        await websocket.accept()
        self._sockets.add(websocket)
        news: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        leave = self._robot.watch(news.put_nowait)

        async def show() -> None:
            while True:
                looks = await news.get()
                while not news.empty():  # a slow page gets only the newest state
                    looks = news.get_nowait()
                await websocket.send_json(looks)

        showing = asyncio.create_task(show())
        try:
            while True:
                self._hear(await websocket.receive_text())
        except (WebSocketDisconnect, RuntimeError, KeyError):  # KeyError: a binary frame, which the page never sends
            pass
        finally:
            leave()
            showing.cancel()
            self._sockets.discard(websocket)

    def _hear(self, said: str) -> None:
        with contextlib.suppress(
            ValueError, TypeError, AttributeError, OverflowError, RecursionError
        ):  # ignore malformed frames
            told: Any = json.loads(said)
            json.dumps(told, ensure_ascii=False).encode()  # raises for half of an emoji (a lone surrogate)
            if isinstance(told.get("say"), str) and told["say"].strip():
                self._robot.hear(told["say"].strip()[:LONGEST], float(told.get("direction", 0.0)))
            if isinstance(told.get("people"), list):
                names = cast("list[object]", told["people"])
                self._robot.see([str(name)[:80] for name in names[:20]])


class _Quiet(uvicorn.Server):
    """A server that leaves the signal handlers as they are."""

    @contextlib.contextmanager
    def capture_signals(self) -> Generator[None]:
        yield


def _is_own_page(websocket: WebSocket) -> bool:
    """Return whether the connection comes from this server's own page, or from a program that is no browser.

    Other sites must not talk to the robot.
    """
    host = websocket.headers.get("host", "")
    origin = websocket.headers.get("origin")
    name = urlsplit(f"//{host}").hostname
    return name in ("127.0.0.1", "localhost", "::1") and (origin is None or urlsplit(origin).netloc == host)
