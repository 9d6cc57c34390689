"""How long to decide among a thousand rules for one slot?

The rules compete in four ways (*shapes*):

- Tied: all rules wait for the input, and the first declared rule wins.
- Weighted: all rules wait for the input, and the greatest weight, declared in the middle, wins.
- Predicates: as Weighted, but each rule also has a predicate on the payload.
- Topics: ``input & topic_i``. A classifier declares a thousand topics and raises one. The rule of that topic wins
  over the other rules and a fallback.
"""

from __future__ import annotations

import asyncio
import statistics
import time
from collections.abc import Iterable

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, Spread, compare
from benchmarks.peers.wire import serve

RULES = 1000
TITLES = {
    "tied": "on the input",
    "weighted": "on the input, weighted",
    "predicates": "on the input, with predicates",
    "topics": "on input & topic_i",
}
LIMIT = 0.002
"""Seconds that the decision may take."""


class Contest:
    """A module in which `rules` rules compete for the output.

    Attributes:
        winner: The name of the rule that must win.
    """

    def __init__(self, shape: str, rules: int) -> None:
        self.module = module = rs.Module("contest")
        self.heard = module.slot("heard", "")
        self.output = module.slot("output", "")
        self.winner = "rival0"
        if shape == "tied":
            for i in range(rules):
                self.rival(f"rival{i}", self.heard.changed)
        elif shape in ("weighted", "predicates"):
            self.winner = f"rival{rules // 2}"
            when = self.heard.changed.where(bool) if shape == "predicates" else self.heard.changed
            for i in range(rules):
                self.rival(f"rival{i}", when, weight=2.0 if i == rules // 2 else 1.0)
        else:
            self.winner = f"rival{rules // 2}"
            topics = [module.signal(f"topic{i}") for i in range(rules)]

            @module.rule(when=self.heard.changed, emits=topics)
            async def classify(ctx: rs.RuleContext) -> None:
                ctx.emit(topics[rules // 2])

            for i, topic in enumerate(topics):
                self.rival(f"rival{i}", self.heard.changed & topic)
            self.rival("fallback", self.heard.changed)

    def rival(self, name: str, when: rs.Condition, weight: float = 1.0) -> None:
        @self.module.rule(when=when, reads=self.heard, writes=self.output, weight=weight, name=name)
        async def speak(ctx: rs.RuleContext) -> None:
            ctx[self.output] = f"{name} {ctx[self.heard]}"


def compete(shape: str, rules: int, inputs: int) -> list[float]:
    """Return the seconds from the input to the answer, for each input."""

    async def measure() -> list[float]:
        contest = Contest(shape, rules)
        times = []
        async with rs.Context(contest.module) as context:
            for n in range(inputs + 3):
                begin = time.perf_counter()
                context.put(contest.heard, f"word {n}")
                said = await context.next(contest.output.changed)
                times.append(time.perf_counter() - begin)
                await context.quiet()
                assert said == f"{contest.winner} word {n}", said
                assert context.read(contest.output) == said
        return times[3:]

    return asyncio.run(measure())


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure each shape. Measure also CLIPS, which decides by salience, with a thousand rules on the input."""
    ours, clips = bench.ours("benchmarks.questions.competing"), bench.clips()
    times: dict[str, list[float]] = {shape: [] for shape in TITLES}
    theirs = []
    inputs = bench.several(20, 8)
    for _ in bench.rounds(5, 2):
        for shape, values in times.items():
            values.append(statistics.median(ours.ask("compete", shape=shape, rules=RULES, inputs=inputs)))
        theirs.append(statistics.median(clips.ask("compete", rules=RULES, inputs=inputs)))
    for shape, values in times.items():
        yield _judged(compare("competing", f"{RULES:,} {TITLES[shape]}", values, "CLIPS, salience", theirs))


def _judged(figure: Figure) -> Figure:
    from dataclasses import replace

    assert isinstance(figure.ours, Spread)
    return replace(figure, target="< 2 ms", reached=figure.ours.median < LIMIT)


if __name__ == "__main__":
    serve(compete)
