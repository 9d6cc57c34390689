"""Visitors of a page, for tests: clients that speak the protocol with an application in memory and in virtual time."""

import asyncio
import contextlib
import functools
import json
from collections.abc import AsyncGenerator, Callable, Coroutine
from typing import Any

from starlette.applications import Starlette

import ravestate as rs
from ravestate.modules import interloc, rawio, webio
from ravestate.runtime.agent import Agent
from ravestate.testing.virtual_loop import VirtualLoop

parrot = rs.Module("parrot", requires=(rawio, interloc))


@parrot.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    name = ctx.payload(interloc.users.added).item
    ctx[rawio.output] = f"Hello {name}!" if name else "Hello!"


@parrot.rule(when=interloc.users.removed, writes=rawio.output)
async def miss(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Bye!"


@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = ctx.payload(rawio.input.changed)


def in_virtual_time(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Run an async test function in virtual time. A wait for an event that never comes raises an error."""

    @functools.wraps(test)
    def run(*arguments: Any, **named: Any) -> None:
        with asyncio.Runner(loop_factory=VirtualLoop) as runner:
            runner.run(test(*arguments, **named))

    return run


async def past(seconds: float) -> None:
    """Wait for some seconds of virtual time."""
    loop = asyncio.get_running_loop()
    over = loop.create_future()
    loop.call_later(seconds, over.set_result, None)
    await over


@contextlib.asynccontextmanager
async def page(*modules: Any, **settings: Any) -> AsyncGenerator[Starlette]:
    """Run the page of an agent. Without modules, the agent repeats each input."""
    app = webio.app(Agent(*(modules or (parrot,)), webio, settings={"webio": settings}))
    async with app.router.lifespan_context(app):
        yield app


class Visit:
    """A WebSocket connection to an application: ``async with Visit(app) as visit``."""

    def __init__(self, app: Starlette, **headers: str) -> None:
        self._app = app
        self._headers = {"host": "127.0.0.1:8420", **headers}
        self._in: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self._out: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.reading = asyncio.Event()
        """While this event is cleared, the client reads nothing, and the server waits in its `send`."""
        self.reading.set()
        self.accepted = False
        self.closed: int | None = None
        """The code with which the server has closed the WebSocket."""
        self.session = ""
        self._said = 0
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> "Visit":
        scope = {
            "type": "websocket",
            "asgi": {"version": "3.0", "spec_version": "2.4"},
            "http_version": "1.1",
            "scheme": "ws",
            "path": "/ws",
            "raw_path": b"/ws",
            "root_path": "",
            "query_string": b"",
            "headers": [(name.encode(), value.encode()) for name, value in self._headers.items()],
            "client": ("127.0.0.1", 50000),
            "server": ("127.0.0.1", 8420),
            "subprotocols": [],
            "state": {},
            "extensions": {"websocket.http.response": {}},
        }
        self._in.put_nowait({"type": "websocket.connect"})
        self._task = asyncio.create_task(self._app(scope, self._in.get, self._send))
        return self

    async def __aexit__(self, *_: object) -> None:
        self.reading.set()
        await self.drop()

    async def over(self) -> None:
        """Wait until the server has ended the connection."""
        assert self._task is not None
        await self._task

    async def drop(self) -> None:
        """Lose the connection, and wait until the server has noticed it."""
        self._in.put_nowait({"type": "websocket.disconnect", "code": 1006})
        await self.over()

    async def _send(self, message: dict[str, Any]) -> None:
        await self.reading.wait()
        if message["type"] == "websocket.accept":
            self.accepted = True
            return
        if message["type"] == "websocket.close":
            self.closed = message["code"]
        message.get("text", "").encode()  # a real server would encode the text
        self._out.put_nowait(message)

    def send(self, text: str | bytes) -> None:
        """Send a text or binary message as it is."""
        self._in.put_nowait({"type": "websocket.receive", "text" if isinstance(text, str) else "bytes": text})

    def tell(self, type: str, **fields: Any) -> None:
        """Send a frame with these fields."""
        self.send(json.dumps({"type": type, **fields}))

    def say(self, text: str, id: str | None = None) -> None:
        """Send a text of the visitor."""
        self._said += 1
        self.tell("say", id=id or f"{self.session[:8]}-{self._said}", text=text)

    async def hello(self, **fields: Any) -> dict[str, Any]:
        """Say hello, and return the welcome."""
        self.tell("hello", v=1, **fields)
        welcome = await self.next()
        self.session = welcome.get("session", "")
        return welcome

    async def next(self) -> dict[str, Any]:
        """Return the next frame, or the message that ends the connection."""
        message = await self._out.get()
        if message["type"] != "websocket.send":
            return message
        return json.loads(message["text"]) if "text" in message else {"type": "sound", "sound": message["bytes"]}

    async def frames(self, until: str) -> list[dict[str, Any]]:
        """Return the next frames, up to the first frame of a type."""
        found = [await self.next()]
        while found[-1]["type"] != until:
            found.append(await self.next())
        return found

    async def messages(self, count: int) -> list[str]:
        """Return the next messages as "speaker: text". Skip other frames."""
        found: list[str] = []
        while len(found) < count:
            frame = await self.next()
            if frame["type"] == "message":
                found.append(f"{frame['from']}: {frame['text']}")
        return found

    def nothing_more(self) -> bool:
        """Return whether the test has read all frames that have arrived."""
        return self._out.empty()
