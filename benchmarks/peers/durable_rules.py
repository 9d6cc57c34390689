"""durable_rules, a rule engine in C. Facts stand for signals, and priorities decide which rule goes first. Actions are
Python functions.

The fallback has the lowest priority, and needs an empty output. The benchmark retracts the facts of an input after the
measurement.
"""

import time
from collections.abc import Callable
from typing import Any

from durable.lang import assert_fact, m, none, pri, retract_fact, ruleset, when_all
from wire import serve

Seconds = float


def build(name: str, k: int, said: list[str]) -> None:
    """Declare a chain of rules (see ``questions/answer.py``)."""
    with ruleset(name):
        last = "input"
        for i in range(1, k + 1):
            when_all(pri(1), m.kind == last)(hop(f"signal-{i}"))
            last = f"signal-{i}"
        when_all(pri(1), m.kind == last)(speak("answer", said))
        when_all(pri(2), m.kind == "input", none(m.kind == "output"))(speak("fallback", said))


def hop(there: str) -> Callable[[Any], None]:
    """Return the action that raises the next signal."""

    def act(c: Any) -> None:
        c.assert_fact({"kind": there, "text": c.m.text})

    return act


def speak(who: str, said: list[str]) -> Callable[[Any], None]:
    """Return the action that says the text."""

    def act(c: Any) -> None:
        text = (c.m if "kind" in c.m._d else c.m_0).text
        said.append(f"{who} {text}")
        c.assert_fact({"kind": "output", "text": text})

    return act


def answer(k: int, inputs: int) -> list[Seconds]:
    """Measure inputs one after another. The rule at the end of a chain of k rules answers each input."""
    said: list[str] = []
    name = f"chain{time.perf_counter_ns()}"
    build(name, k, said)
    kinds = ["input", *(f"signal-{i}" for i in range(1, k + 1)), "output"]
    times = []
    for n in range(inputs):
        said.clear()
        text = f"word {n}"
        begin = time.perf_counter()
        assert_fact(name, {"kind": "input", "text": text})
        times.append(time.perf_counter() - begin)
        assert said == [f"answer {text}"], said
        for kind in kinds:
            retract_fact(name, {"kind": kind, "text": text})
    return times


if __name__ == "__main__":
    serve(answer)
