"""Clients of the board for tests. They speak the board's protocol with an application in memory, in virtual time."""

import asyncio
import contextlib
import functools
from collections.abc import AsyncGenerator, Callable, Coroutine
from typing import Any

from starlette.applications import Starlette

import ravestate as rs
from modules.platform.webio.visit import Visit, parrot
from ravestate.board.application import INSIDE, RecordedAgent, routes
from ravestate.board.trace_file import Recording
from ravestate.modules import rawio, webio
from ravestate.runtime.clock import Clock
from ravestate.testing.virtual_loop import VirtualLoop

__all__ = ["Look", "board", "gossip", "in_virtual_time", "passing"]

gossip = rs.Module("gossip", requires=(rawio,))
question = gossip.signal("question")
secret: rs.Slot[object] = gossip.slot("secret", None)
cheered: rs.Signal[Any] = gossip.signal("cheered", payload=dict)


@gossip.rule(when=rawio.input.changed, emits=question)
async def classify(ctx: rs.RuleContext) -> None:
    """Classify an input as a question or something else."""
    await ctx.sleep(0.2)
    if "?" in ctx.payload(rawio.input.changed):
        ctx.emit(question)


@gossip.rule(when=question, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> None:
    """Answer a question."""
    ctx[rawio.output] = "Yes."


@gossip.rule(when=rawio.input.changed, writes=rawio.output)
async def talk(ctx: rs.RuleContext) -> None:
    """Answer when no other rule does."""
    ctx[rawio.output] = "I see."


@gossip.rule(when=cheered)
async def bow(ctx: rs.RuleContext) -> None:
    """A rule that does nothing. It waits for a signal with a payload."""


async def passing(seconds: float) -> None:
    """Wait for some seconds of virtual time."""
    loop = asyncio.get_running_loop()
    assert isinstance(loop, VirtualLoop)
    await Clock(loop).sleep(seconds)


class Loop(VirtualLoop):
    """A virtual loop that runs work for an executor immediately, without a thread."""

    def run_in_executor(self, executor: Any, func: Any, *args: Any) -> Any:
        """Run the function immediately."""
        future = self.create_future()
        try:
            future.set_result(func(*args))
        except Exception as error:
            future.set_exception(error)
        return future


def in_virtual_time(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Run an async test function on a virtual loop."""

    @functools.wraps(test)
    def run(*arguments: Any, **named: Any) -> None:
        with asyncio.Runner(loop_factory=Loop) as runner:
            runner.run(test(*arguments, **named))

    return run


@contextlib.asynccontextmanager
async def board(
    *modules: Any,
    recording: Recording | None = None,
    recorded: bool = True,
    title: str | None = "Elske",
    **settings: Any,
) -> AsyncGenerator[Starlette]:
    """Serve the chat page of an agent, and its board."""
    agent = RecordedAgent(*(modules or (gossip, parrot)), webio, settings={"webio": settings})
    beside = routes(agent.recorders if recorded else None, recording, title)
    app = webio.app(agent, beside, INSIDE)
    async with app.router.lifespan_context(app):
        yield app


class Look(Visit):
    """A connection to the board, as an inspector: ``async with Look(app) as look``."""

    def __init__(self, app: Starlette, **headers: str) -> None:
        async def at_board(scope: Any, receive: Any, send: Any) -> None:
            await app({**scope, "path": "/board/ws", "raw_path": b"/board/ws"}, receive, send)

        super().__init__(at_board, **headers)  # type: ignore[arg-type]  # called like an application
        self.records: list[dict[str, Any]] = []

    async def begin(self, **fields: Any) -> dict[str, Any]:
        """Say hello, read the welcome and the state that follows it, and return the welcome."""
        self.tell("hello", v=1, **fields)
        welcome = await self.next()
        if welcome["type"] == "welcome":
            assert (await self.next())["type"] == "state"
        return welcome

    async def answer(self, type: str) -> dict[str, Any]:
        """Return the next frame of a type. Collect the records of the frames before it."""
        while True:
            frame = await self.next()
            if frame["type"] == "records":
                self.records += frame["records"]
            if frame["type"] == type:
                return frame

    async def until(self, kind: str, **fields: Any) -> dict[str, Any]:
        """Wait for a record of a kind with these fields, and return it."""
        while (found := self.found(kind, **fields)) is None:
            await self.answer("records")
        return found

    def found(self, kind: str, **fields: Any) -> dict[str, Any] | None:
        """Return the first collected record of a kind with these fields; None if there is none."""
        return next(
            (r for r in self.records if r["kind"] == kind and all(r.get(k) == v for k, v in fields.items())),
            None,
        )
