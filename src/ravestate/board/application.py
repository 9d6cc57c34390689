"""The routes of the board, the web debugger. The chat page's server serves the board, with the same access checks."""

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
from ravestate.board.trace_file import Recording, Recordings, read_apart
from ravestate.modules.platform.webio.access import PAUSE
from ravestate.modules.platform.webio.application import AccessMiddleware
from ravestate.modules.platform.webio.pages import Pages
from ravestate.runtime.agent import Agent
from ravestate.runtime.context import Context

PAGE = Path(__file__).parent / "page"
"""The folder of the board's page, which ``npm run build`` in ``frontend/`` makes."""

INSIDE = "board/"  # the board's address, relative to the chat page

LARGEST = 64 * 1024 * 1024
"""The maximum number of bytes in an uploaded recording: twice the largest file that the page exports, which has some
125,000 records of 270 bytes."""

AT_ONCE = 4  # the maximum number of uploads at the same time
LONGEST = 300.0  # the maximum number of seconds that an upload may take


class RecordedAgent(Agent):
    """An agent that records each context from its start, so that the board can show the past."""

    def __init__(self, *modules: Any, **options: Any) -> None:
        super().__init__(*modules, **options)
        self.recorders = Recorders()

    def context(self, **options: Any) -> Context:
        """Return a new context, which is recorded from its start."""
        context = super().context(**options)
        self.recorders.of(context, whole=True)
        return context


def routes(
    recorders: Recorders | None = None, recording: Recording | None = None, title: str | None = None
) -> list[BaseRoute]:
    """Return the routes below ``/board``, for ``webio.app(agent, routes(), inside=INSIDE)``.

    The board is for the agent's developers: anybody with access to the page can inspect and change every conversation.
    Sites that may embed the chat may neither embed the board nor connect to it. Without `recorders`, recording
    starts when a board opens. If there is a `recording`, a board opens with it, unless the board's address chooses a
    conversation; and ``/`` leads to the board. Without a `title`, the board shows the name that the agent gives itself.
    """
    known = Recorders() if recorders is None else recorders
    recordings = Recordings(recording)
    receiving = asyncio.Semaphore(AT_ONCE)
    reading = asyncio.Lock()  # one recording at a time: reading a file needs many times the file's size in memory

    async def inspect(socket: WebSocket) -> None:
        state = socket.app.state
        await Inspector(socket, state.access, state.sessions, known, recordings, title).run()

    async def receive(request: Request) -> Response:
        bearer = request.headers.get("authorization", "").removeprefix("Bearer ")
        if not request.app.state.access.admits(bearer):
            await asyncio.sleep(PAUSE)
            return PlainTextResponse("the token is wrong, or missing", 401)
        if receiving.locked():
            return PlainTextResponse(f"{AT_ONCE} uploads are in progress: try again", 503, {"retry-after": "10"})
        async with receiving:
            return await read(request)

    async def read(request: Request) -> Response:
        data = bytearray()
        try:
            async with asyncio.timeout(LONGEST):
                async for part in request.stream():
                    data += part
                    if len(data) > LARGEST:
                        return PlainTextResponse(f"a recording has at most {LARGEST:,} bytes", 413)
        except TimeoutError:
            return PlainTextResponse(f"the upload took more than {LONGEST:g} s", 408)
        except ClientDisconnect:
            return Response(status_code=400)  # the client has disconnected, so it never reads this answer
        try:
            async with reading:
                recording = await asyncio.to_thread(read_apart, bytes(data))
        except ValueError as error:
            return PlainTextResponse(f"this is not a trace: {error}", 422)
        return JSONResponse({"recording": recordings.put(recording)}, 201)

    async def redirect(request: Request) -> Response:
        return RedirectResponse(request.url.path + "/", 308)

    async def look(request: Request) -> Response:
        return RedirectResponse(INSIDE, 307)

    return [
        *([] if recording is None else [Route("/", look)]),  # a server for a recording has no chat page
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
