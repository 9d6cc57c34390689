"""experta, a rule engine in pure Python after the model of CLIPS. Facts stand for signals, and salience decides which
rule goes first."""

import time

from experta import MATCH, NOT, Fact, KnowledgeEngine, Rule
from wire import serve

Seconds = float


class Signal(Fact):
    """A signal by its name, with the text of the input."""


def engine_of(k: int, said: list[str]) -> KnowledgeEngine:
    """Return an engine with the same chain of rules as CLIPS (``clips_rules.py``)."""
    members = {}

    def hop(self: KnowledgeEngine, number: int, text: str) -> None:
        self.declare(Signal(name=f"signal-{number}", text=text))

    def speak(self: KnowledgeEngine, name: str, text: str) -> None:
        said.append(f"{name} {text}")
        self.declare(Signal(name="output", text=f"{name} {text}"))

    last = "input"
    for i in range(1, k + 1):
        rule = Rule(Signal(name=last, text=MATCH.text))
        members[f"hop_{i}"] = rule(lambda self, text, i=i: hop(self, i, text))
        last = f"signal-{i}"
    for name, on, salience in (("answer", last, 1), ("fallback", "input", -1)):
        rule = Rule(Signal(name=on, text=MATCH.text), NOT(Signal(name="output")), salience=salience)
        members[name] = rule(lambda self, text, name=name: speak(self, name, text))
    return type("Chain", (KnowledgeEngine,), members)()


def answer(k: int, inputs: int) -> list[Seconds]:
    """Measure inputs one after another. The rule at the end of a chain of k rules answers each input."""
    said: list[str] = []
    engine = engine_of(k, said)
    times = []
    for n in range(inputs):
        engine.reset()
        said.clear()
        begin = time.perf_counter()
        engine.declare(Signal(name="input", text=f"word {n}"))
        engine.run()
        times.append(time.perf_counter() - begin)
        assert said == [f"answer word {n}"], said
    return times


if __name__ == "__main__":
    serve(answer)
