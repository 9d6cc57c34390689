"""What does the board cost the agent that it shows?

The agent of the question ``answer`` (a chain of four rules) has a conversation on the web page, with or without the
board. In one case, a board's browser is connected over a WebSocket. The agent answers one input after another. This is
the worst case for the board: a rule that computes would make the same records in more time. Each figure is the
processor time of an answer. Within each measurement, the recorder, which keeps the board's records, reaches its limit
and starts again several times.
"""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Iterable
from typing import Any

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare
from benchmarks.peers.wire import serve
from ravestate.board.recorder import PAUSE

LENGTH = 4
WARM = 5.0
"""Seconds for which each contestant answers before the measurement, so that the recorder's first burst is over."""

TURN = 0.6
"""Seconds of processor time for which a contestant answers, before the turn of the next contestant."""

TURNS = 15
"""Turns of each contestant in one repetition."""


def chain() -> tuple[rs.Module, rs.Slot[str], rs.Slot[str]]:
    """Return the agent's module, its input slot and its output slot. Each rule raises the signal for the next rule."""
    module = rs.Module("chain")
    heard, output = module.slot("heard", ""), module.slot("output", "", always=True)
    cause: rs.Signal[Any] = heard.changed
    for number in range(LENGTH):
        signal = module.signal(f"signal_{number}")

        async def pass_on(ctx: rs.RuleContext, signal: rs.Signal[None] = signal) -> None:
            ctx.emit(signal)

        module.rule(when=cause, emits=signal, name=f"rule_{number}")(pass_on)
        cause = signal

    @module.rule(when=cause, writes=output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[output] = "answer"

    @module.rule(when=heard.changed, writes=output)
    async def fall_back(ctx: rs.RuleContext) -> None:
        raise AssertionError("the fallback rule answered")

    return module, heard, output


class Talk:
    """A conversation of a web page, with or without the board."""

    def __init__(self, context: rs.Context, heard: rs.Slot[str], output: rs.Slot[str], recorder: Any) -> None:
        self._context = context
        self._heard = heard
        self._output = output
        self._recorder = recorder
        self._number = 0

    async def answer(self, seconds: float) -> float:
        """Answer for `seconds` seconds of processor time. Return the seconds of processor time for one answer."""
        if self._recorder is not None:
            _begin_anew(self._recorder)
        first, begin, used = self._number, time.process_time(), 0.0
        while used < seconds:
            for _ in range(25):
                self._number += 1
                self._context.put(self._heard, f"word {self._number}")
                await self._context.next(self._output.changed)
            used = time.process_time() - begin
        return used / (self._number - first)


def _begin_anew(recorder: Any) -> None:
    """Cancel the allowance that an idle recorder has saved up during the turns of the other contestants."""
    recorder._granted = asyncio.get_running_loop().time()
    recorder._left = max(1, min(recorder._left, int(recorder._rate * PAUSE)))
    recorder._idle_share.share()


def answered() -> list[list[float]]:
    """Return three lists: the seconds for an answer without a recorder, with a recorder, and with a recorder and a
    board. Each list has one figure for each turn.

    The contestants take turns in one process, because two processes would differ by more than the contestants do.
    """
    from websockets.asyncio.client import connect

    from ravestate.board.application import INSIDE, RecordedAgent, routes
    from ravestate.modules import webio
    from ravestate.modules.platform.webio.server import Server
    from ravestate.runtime.agent import Agent

    async def measure() -> list[list[float]]:
        async with contextlib.AsyncExitStack() as stack:

            async def talk(kind: type[Agent]) -> tuple[Talk, Server]:
                module, heard, output = chain()
                agent = kind(module, webio, settings={"webio": {"port": 0}})
                recorders = agent.recorders if isinstance(agent, RecordedAgent) else None
                beside = () if recorders is None else routes(recorders)
                server = await stack.enter_async_context(Server(agent, beside, INSIDE))
                session = await server.app.state.sessions.open()
                await asyncio.sleep(0.05)
                recorder = None if recorders is None else recorders.of(session.context)
                return Talk(session.context, heard, output, recorder), server

            bare, _ = await talk(Agent)
            recorded, _ = await talk(RecordedAgent)
            watched, server = await talk(RecordedAgent)
            address = server.address.replace("http", "ws") + "board/ws"
            socket = await stack.enter_async_context(connect(address, compression=None, max_size=None))
            await socket.send('{"type": "hello", "v": 1}')
            reader = asyncio.create_task(_read(socket))
            stack.callback(reader.cancel)
            talks = (bare, recorded, watched)
            for one in talks:
                await one.answer(WARM)
            turns = [[await one.answer(TURN) for one in talks] for _ in range(TURNS)]
            return [list(times) for times in zip(*turns, strict=True)]

    return asyncio.run(measure())


async def _read(socket: Any) -> None:
    """Read the frames as a browser does. The reader shares the loop, so the figure includes the reader's time."""
    async for _ in socket:
        pass


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare the agent with and without a board."""
    ours = bench.ours("benchmarks.questions.watching")
    bare: list[float] = []
    mounted: list[float] = []
    watched: list[float] = []
    for _ in bench.rounds(3, 1):
        for times, found in zip((bare, mounted, watched), ours.ask("answered"), strict=True):
            times += found
    for title, times in (("recorded, no board open", mounted), ("recorded, a board open", watched)):
        yield compare("watching", title, times, "no board", bare, target="<= 1.05", reach=lambda ratio: ratio <= 1.05)


if __name__ == "__main__":
    serve(answered)
