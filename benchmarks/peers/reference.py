"""The paper's reference implementation (Ravestate 0.7): states for rules, properties for slots, 20 ticks a second.

The setup follows the implementation's own modules: a module in a ``with`` block, a context by the module's name, and
input through ``ravestate_rawio.say``.
"""

import random
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import ravestate_rawio as rawio
from wire import serve

import ravestate as rs

Seconds = float
TICK: Seconds = 1 / 20

serial = 0  # the modules live in one global registry, so each module needs a name of its own


class Agent:
    """A context with a chain of rules (see ``questions/answer.py``). `said` has the answers to the last input."""

    def __init__(self, k: int, unrelated: int) -> None:
        global serial
        serial += 1
        self.said: list[str] = []
        self.seen = threading.Event()
        with rs.Module(name=f"chain{serial}", depends=(rawio.mod,)) as self.module:
            last = rawio.prop_in.changed()
            for i in range(1, k + 1):
                raised = rs.Signal(name=f"signal{i}")
                self.raiser(f"hop{i}", last, raised)
                last = raised
            self.speaker("answer", last)
            self.speaker("fallback", rawio.prop_in.changed())
            for i in range(unrelated):
                self.raiser(f"unrelated{i}", rs.Signal(name=f"other{i}"), rs.Signal(name=f"done{i}"))
        self.context = rs.Context(self.module.name)

    def raiser(self, name: str, condition: rs.Signal, raised: rs.Signal) -> None:
        def hop(ctx: rs.ContextWrapper) -> rs.Emit:
            return rs.Emit()

        hop.__name__ = name
        rs.state(cond=condition, signal=raised)(hop)

    def speaker(self, name: str, condition: rs.Signal) -> None:
        def speak(ctx: rs.ContextWrapper) -> None:
            text = f"{name} {ctx[rawio.prop_in]}"
            ctx[rawio.prop_out] = text
            self.said.append(text)
            self.seen.set()

        speak.__name__ = name
        rs.state(cond=condition, read=rawio.prop_in, write=rawio.prop_out)(speak)

    def turn(self, text: str, expected: str) -> Seconds:
        self.said.clear()
        self.seen.clear()
        begin = time.perf_counter()
        rawio.say(self.context, text)
        self.seen.wait(timeout=10)
        end = time.perf_counter()
        # The wait is long enough for the fallback to answer, and for the next input to come anywhere between two ticks.
        time.sleep((4 + random.random()) * TICK)
        assert self.said == [expected], self.said
        return end - begin


@contextmanager
def running(k: int, unrelated: int = 0) -> Iterator[Agent]:
    agent = Agent(k, unrelated)
    agent.context.run()
    try:
        time.sleep(4 * TICK)
        agent.turn("warm", "answer warm")
        yield agent
    finally:
        agent.context.shutdown()  # an idle context would take processor time from the next contestant


def answer(k: int, inputs: int) -> list[Seconds]:
    """Measure inputs one after another. The rule at the end of a chain of k rules answers each input."""
    with running(k) as agent:
        return [agent.turn(f"word {n}", f"answer word {n}") for n in range(inputs)]


def idle(seconds: float, unrelated: int) -> float:
    """Return the share of a core that an idle context takes."""
    with running(1, unrelated):
        time.sleep(1)
        wall, cpu = time.perf_counter(), time.process_time()
        time.sleep(seconds)
        return (time.process_time() - cpu) / (time.perf_counter() - wall)


if __name__ == "__main__":
    serve(answer, idle)
