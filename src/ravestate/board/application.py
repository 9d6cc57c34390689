"""The board's routes, to be served beside the chat page and behind its checks."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.websockets import WebSocket

from ravestate.board.inspector import Inspector
from ravestate.board.recorder import Recorders
from ravestate.board.shelf import Shelf
from ravestate.board.trace_file import Recording, read_trace
from ravestate.modules.platform.webio.access import PAUSE
from ravestate.modules.platform.webio.application import AccessMiddleware
from ravestate.modules.platform.webio.pages import Pages
from ravestate.runtime.agent import Agent
from ravestate.runtime.context import Context

__all__ = ["INSIDE", "PAGE", "LARGEST", "RecordedAgent", "routes"]

PAGE = Path(__file__).parent / "page"
"""What ``npm run build`` in ``frontend/`` makes."""

INSIDE = "board/"
"""Where the board is, seen from the chat page."""

LARGEST = 64 * 1024 * 1024
"""Bytes that a recording may have that is sent to be looked at: twice as many as the page exports at most, some 125,000
records of 270 bytes."""

AT_ONCE = 4
"""Recordings that are received at once."""

LONGEST = 300.0
"""Seconds that a recording may take to come."""


class RecordedAgent(Agent):
    """An agent whose contexts are recorded from their beginning, so that the past can be looked at."""

    def __init__(self, *modules: Any, **options: Any) -> None:
        super().__init__(*modules, **options)
        self.recorders = Recorders()

    def context(self, **options: Any) -> Context:
        """Make another context, and listen to it."""
        context = super().context(**options)
        self.recorders.of(context, whole=True)
        return context


def routes(
    recorders: Recorders | None = None, recording: Recording | None = None, title: str | None = None
) -> list[BaseRoute]:
    """The routes below ``/board``, for ``webio.app(agent, routes(), inside=INSIDE)``.

    Whoever may see the page may look into every conversation on it, and act on it: this is for those who make an agent.
    Sites that may embed the chat may not embed the board, nor connect to it.

    Args:
        recorders: Those of a `RecordedAgent`; without them, recording begins when somebody looks.
        recording: What is shown to who asks for no conversation.
        title: What the agent is called; None: what it calls itself.
    """
    known = Recorders() if recorders is None else recorders
    shelf = Shelf(recording)
    receiving = asyncio.Semaphore(AT_ONCE)
    reading = asyncio.Lock()  # one recording at a time: while it is read it takes many times its size

    async def inspect(socket: WebSocket) -> None:
        state = socket.app.state
        await Inspector(socket, state.access, state.sessions, known, shelf, title).run()

    async def receive(request: Request) -> Response:
        bearer = request.headers.get("authorization", "").removeprefix("Bearer ")
        if not request.app.state.access.admits(bearer):
            await asyncio.sleep(PAUSE)
            return PlainTextResponse("the token is wrong, or missing", 401)
        if receiving.locked():
            return PlainTextResponse(
                f"{AT_ONCE} recordings are being sent already: try again", 503, {"retry-after": "10"}
            )
        async with receiving:
            return await read(request)

    async def read(request: Request) -> Response:
        data = bytearray()
        try:
            async with asyncio.timeout(LONGEST):
                async for piece in request.stream():
                    data += piece
                    if len(data) > LARGEST:
                        return PlainTextResponse(f"a recording has at most {LARGEST:,} bytes", 413)
        except TimeoutError:
            return PlainTextResponse(f"a recording has to come within {LONGEST:g} s", 408)
        except ClientDisconnect:
            return Response(status_code=400)  # to nobody
        try:
            async with reading:
                recording = await asyncio.to_thread(read_trace, bytes(data))
        except ValueError as error:
            return PlainTextResponse(f"this is no trace: {error}", 422)
        return JSONResponse({"recording": shelf.put(recording)}, 201)

    async def redirect(request: Request) -> Response:
        return RedirectResponse(request.url.path + "/", 308)

    async def look(request: Request) -> Response:
        return RedirectResponse(INSIDE, 307)

    return [
        *([] if recording is None else [Route("/", look)]),  # there is nobody to talk with
        Route("/board", redirect),
        Mount(
            "/board",
            routes=[
                WebSocketRoute("/ws", inspect),
                Route("/recordings", receive, methods=["POST"]),
                Mount("/", Pages(PAGE)),
            ],
            middleware=[Middleware(AccessMiddleware, inside=True)],
        ),
    ]
