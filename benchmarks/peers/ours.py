"""Ravestate with the same work as the peers: by its public interface, on the event loop, in real time."""

import asyncio
import time
from collections.abc import Coroutine
from typing import Any

import ravestate as rs
from benchmarks.peers.wire import serve
from ravestate.testing import simulate

Seconds = float


class Agent:
    """A module with a chain of rules (see ``questions/answer.py``). `said` has the answers to the last input.

    Args:
        k: The length of the chain.
        unrelated: The number of other rules, each on a signal of its own.
        threads: Whether the answering rule is a plain function, which runs in a worker thread.
    """

    def __init__(self, k: int, unrelated: int = 0, threads: bool = False) -> None:
        self.module = module = rs.Module("chain")
        self.heard = module.slot("heard", "")
        self.output = module.slot("output", "")
        self.said: list[str] = []
        last = self.heard.changed
        for i in range(1, k + 1):
            raised = module.signal(f"signal{i}")
            self.raiser(f"hop{i}", last, raised)
            last = raised
        self.speaker("answer", last, threads)
        self.speaker("fallback", self.heard.changed)
        for i in range(unrelated):
            self.raiser(f"unrelated{i}", module.signal(f"other{i}"), module.signal(f"done{i}"))

    def raiser(self, name: str, when: rs.Condition, raised: rs.Signal[None]) -> None:
        @self.module.rule(when=when, emits=raised, name=name)
        async def hop(ctx: rs.RuleContext) -> None:
            ctx.emit(raised)

    def speaker(self, name: str, when: rs.Condition, threads: bool = False) -> None:
        def speak(ctx: rs.RuleContext) -> None:
            text = f"{name} {ctx[self.heard]}"
            self.said.append(text)
            ctx[self.output] = text

        async def speak_at_once(ctx: rs.RuleContext) -> None:
            speak(ctx)

        self.module.rule(when=when, reads=self.heard, writes=self.output, name=name)(
            speak if threads else speak_at_once
        )

    async def turn(self, context: rs.Context, text: str, expected: str) -> Seconds:
        """Give an input; return the time until the caller has the answer (seconds)."""
        self.said.clear()
        begin = time.perf_counter()
        context.put(self.heard, text)
        said = await context.next(self.output.changed)
        end = time.perf_counter()
        assert said == expected, said
        assert self.said == [expected], self.said
        return end - begin


class Stage:
    """Keeps contexts alive between requests, so that contestants can take turns."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self.agents: dict[Any, tuple[Agent, rs.Context]] = {}

    def run(self, work: Coroutine[Any, Any, Any]) -> Any:
        return self.loop.run_until_complete(work)

    def agent(self, *options: Any) -> tuple[Agent, rs.Context]:
        if options not in self.agents:
            agent = Agent(*options)
            context = self.run(rs.Context(agent.module).__aenter__())
            self.agents[options] = agent, context
            for n in range(20):
                self.run(agent.turn(context, f"warm {n}", f"answer warm {n}"))
        return self.agents[options]


stage = Stage()


def answer(k: int, inputs: int, unrelated: int = 0, threads: bool = False) -> dict[str, list[Seconds]]:
    """Measure inputs one after another. The rule at the end of a chain of k rules answers each input.

    Return the times of each input: `answered` until the answer, and `turn` until the agent is quiet again.
    """
    agent, context = stage.agent(k, unrelated, threads)

    async def measure() -> dict[str, list[Seconds]]:
        answered, turns = [], []
        for n in range(inputs):
            begin = time.perf_counter()
            answered.append(await agent.turn(context, f"word {n}", f"answer word {n}"))
            await context.quiet()
            turns.append(time.perf_counter() - begin)
            assert len(agent.said) == 1, agent.said  # a second text would be a late answer of the fallback rule
        return {"answered": answered, "turn": turns}

    return stage.run(measure())


def simulated(k: int, inputs: int) -> list[Seconds]:
    """Measure the same inputs in virtual time, with `simulate`."""
    agent = Agent(k)
    times = []
    with simulate(agent.module, trace=False) as sim:
        for n in range(inputs):
            begin = time.perf_counter()
            sim.put(agent.heard, f"word {n}")
            times.append(time.perf_counter() - begin)
            assert sim.read(agent.output) == f"answer word {n}"
    return times


def idle(seconds: float, unrelated: int) -> float:
    """Return the share of a core that an idle context takes."""

    async def measure() -> float:
        agent = Agent(1, unrelated)
        async with rs.Context(agent.module) as context:
            await agent.turn(context, "word", "answer word")
            await asyncio.sleep(1)
            wall, cpu = time.perf_counter(), time.process_time()
            await asyncio.sleep(seconds)
            return (time.process_time() - cpu) / (time.perf_counter() - wall)

    return asyncio.run(measure())


if __name__ == "__main__":
    serve(answer, simulated, idle)
