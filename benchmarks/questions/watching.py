"""What does an agent cost that is looked into?

The agent of the question ``answer`` (a chain of four rules, an answer that competes with a fallback) as a conversation
of the web page, with the board mounted or not; a board's browser looks on over a WebSocket or does not. The agent does
nothing but answer, one input after another: the worst case for whoever looks on, as a rule that thinks makes the same
records in more time. Each figure is the processor time of an answer, over some seconds, as a recorder that has had
its fill comes and goes.
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

LENGTH = 4
ANSWERS = 40_000
"""Over which one is timed."""

WARM = 6.0
"""Seconds for which it answers before it is timed: bursts that a recorder takes gladly are over by then."""


def chain() -> tuple[rs.Module, rs.Slot[str], rs.Slot[str]]:
    """The agent: each rule raises the next one's signal."""
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


def answered(mounted: bool, watched: bool) -> float:
    """Seconds for an answer."""
    from websockets.asyncio.client import connect

    from ravestate.board.application import INSIDE, RecordedAgent, routes
    from ravestate.modules import webio
    from ravestate.modules.platform.webio.server import Server
    from ravestate.runtime.agent import Agent

    async def measure() -> float:
        module, heard, output = chain()
        settings = {"webio": {"port": 0}}
        agent = (RecordedAgent if mounted else Agent)(module, webio, settings=settings)
        beside = routes(agent.recorders) if isinstance(agent, RecordedAgent) else ()
        async with Server(agent, beside, INSIDE) as server, contextlib.AsyncExitStack() as stack:
            session = await server._app.state.sessions.open()  # pyright: ignore[reportPrivateUsage]
            await asyncio.sleep(0.05)
            context = session.context
            if watched:
                address = server.address.replace("http", "ws") + "board/ws"
                socket = await stack.enter_async_context(connect(address, compression=None, max_size=None))
                await socket.send('{"type": "hello", "v": 1}')
                reader = asyncio.create_task(_read(socket))
                stack.callback(reader.cancel)
            number = 0

            async def answers(count: int) -> None:
                nonlocal number
                for _ in range(count):
                    number += 1
                    context.put(heard, f"word {number}")
                    await context.next(output.changed)

            warm = time.perf_counter() + (WARM if mounted else 1.0)
            while time.perf_counter() < warm:
                await answers(100)
            begin = time.process_time()
            await answers(ANSWERS)
            return (time.process_time() - begin) / ANSWERS

    return asyncio.run(measure())


async def _read(socket: Any) -> None:
    """As a browser does; here it shares the loop, so what it takes is counted as well."""
    async for _ in socket:
        pass


def ask(bench: Bench) -> Iterable[Figure]:
    """With and without somebody who looks on."""
    ours = bench.ours("benchmarks.questions.watching")
    bare: list[float] = []
    mounted: list[float] = []
    watched: list[float] = []
    for _ in bench.rounds(7, 2):
        bare.append(ours.ask("answered", mounted=False, watched=False))
        mounted.append(ours.ask("answered", mounted=True, watched=False))
        watched.append(ours.ask("answered", mounted=True, watched=True))
    for title, times in (("recorded, nobody looks on", mounted), ("a board looks on", watched)):
        yield compare(
            "watching", title, times, "no board", bare, target="<= 1.05", reach=lambda ratio: ratio <= 1.05
        )


if __name__ == "__main__":
    serve(answered)
