"""CLIPS, the C rule engine, through clipspy. Facts stand for signals, and salience decides which rule goes first.
Actions are Python functions.

There are two styles. In ``raise``, a rule's action is a Python function that asserts the next fact itself, as a rule
function of Ravestate raises a signal. In ``return``, the Python function only returns a decision, and the rule asserts
the fact in C. The style ``return`` is the fastest way to use CLIPS with Python actions.
"""

import time
from collections.abc import Callable

import clips
from wire import serve

Seconds = float
TEXT = "(slot text (type STRING))"


class Agent:
    """An environment with a chain of rules (see ``questions/answer.py``). `said` has the answers to the
    last input."""

    def __init__(self, k: int, style: str, unrelated: int = 0) -> None:
        self.env = env = clips.Environment()
        self.said: list[str] = []
        env.build(f"(deftemplate input {TEXT})")
        env.build(f"(deftemplate output {TEXT})")
        self.input = env.find_template("input")
        self.output = env.find_template("output")
        last = "input"
        for i in range(1, k + 1):
            env.build(f"(deftemplate signal-{i} {TEXT})")
            if style == "raise":
                env.define_function(self.raiser(f"signal-{i}"), f"hop-{i}")
                act = f"(hop-{i} ?text)"
            else:
                env.define_function(self.decider(), f"hop-{i}")
                act = f"(if (hop-{i} ?text) then (assert (signal-{i} (text ?text))))"
            env.build(f"(defrule hop-{i} ({last} (text ?text)) => {act})")
            last = f"signal-{i}"
        self.speaker("answer", on=last, salience=1, style=style)
        self.speaker("fallback", on="input", salience=-1, style=style)
        for i in range(unrelated):
            env.build(f"(defrule unrelated-{i} (other-{i}) => (assert (done-{i})))")

    def raiser(self, signal: str) -> Callable[[str], None]:
        template = self.env.find_template(signal)

        def hop(text: str) -> None:
            template.assert_fact(text=text)

        return hop

    def decider(self) -> Callable[[str], bool]:
        def hop(text: str) -> bool:
            return True

        return hop

    def speaker(self, name: str, on: str, salience: int, style: str) -> None:
        def speak_and_raise(text: str) -> None:
            self.said.append(f"{name} {text}")
            self.output.assert_fact(text=f"{name} {text}")

        def speak(text: str) -> str:
            self.said.append(f"{name} {text}")
            return f"{name} {text}"

        if style == "raise":
            self.env.define_function(speak_and_raise, name)
            act = f"({name} ?text)"
        else:
            self.env.define_function(speak, name)
            act = f"(assert (output (text ({name} ?text))))"
        # Once there is an output, no other rule may write it. So the fallback stays quiet.
        self.env.build(f"(defrule {name} (declare (salience {salience})) ({on} (text ?text)) (not (output)) => {act})")

    def turn(self, text: str, expected: str) -> tuple[Seconds, Seconds]:
        """Give an input. Return the time to the answer, and the time with the clean-up for the next input."""
        self.said.clear()
        begin = time.perf_counter()
        self.input.assert_fact(text=text)
        self.env.run()
        said = self.said[-1]
        seen = time.perf_counter()
        self.env.reset()
        end = time.perf_counter()
        assert said == expected, said
        assert self.said == [expected], self.said
        return seen - begin, end - begin


def answer(k: int, inputs: int, style: str, before: int = 20) -> dict[str, list[Seconds]]:
    """Measure inputs one after another. The rule at the end of a chain of k rules answers each input.

    Each batch has an environment of its own, because clipspy 1.0.6 slows down with every input, whether or not the
    facts are removed. `before` is the number of inputs before the measurement. Return the times of each input:
    `answered` until the answer, and `turn` with the clean-up for the next input.
    """
    agent = Agent(k, style)
    for n in range(before):
        agent.turn(f"warm {n}", f"answer warm {n}")
    times = [agent.turn(f"word {n}", f"answer word {n}") for n in range(inputs)]
    return {"answered": [seen for seen, _ in times], "turn": [end for _, end in times]}


def compete(rules: int, inputs: int) -> list[Seconds]:
    """Measure inputs for each of which `rules` rules compete for one output. The greatest salience wins."""
    agent = Agent(0, "raise")
    for i in range(rules - 2):  # "answer" and "fallback" compete as well
        agent.speaker(f"rival-{i}", on="input", salience=0, style="raise")
    for n in range(3):
        agent.turn(f"warm {n}", f"answer warm {n}")
    return [agent.turn(f"word {n}", f"answer word {n}")[0] for n in range(inputs)]


def build(rules: int) -> Seconds:
    """Return the time to build this number of rules, each on its own signal."""
    begin = time.perf_counter()
    Agent(1, "raise", unrelated=rules)
    return time.perf_counter() - begin


if __name__ == "__main__":
    serve(answer, compete, build)
