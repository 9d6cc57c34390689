"""The answer to why a rule did not fire: how far it came, the reason in words, what it lacked, and what befell it (L25).

Values; `why_not` has them from a trace.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["FURTHEST", "Missing", "Moment", "Raiser", "Verdict", "WhyNot"]

Verdict = Literal[
    "fired",  # it did
    "running",  # it does
    "waiting",  # it is ready, and kept waiting
    "outrun",  # it was ready, and another one answered
    "resigned",
    "failed",
    "gated",  # a predicate on a slot was false
    "young",  # its spikes were not old enough yet
    "eliminated",  # others waited for it until its patience ran out
    "withdrawn",  # the spike was wiped, superseded, or dropped
    "lacked",  # a signal was missing
    "passed",  # it hears the signal, but did not take the spike
    "untouched",  # nothing of what it hears occurred
    "retired",
]
"""How far a rule came."""

FURTHEST: dict[str, int] = {
    verdict: rank
    for rank, verdict in enumerate(
        (
            "fired", "running", "waiting", "outrun", "failed", "resigned", "gated", "young", "eliminated", "withdrawn",
            "lacked", "passed", "untouched", "retired",
        )
    )
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Raiser:
    """A rule that might have raised a missing signal, and how that ended in this causal group.

    Attributes:
        outcome: Of its run; ``running``; or ``not run``.
        words: The same in words.
    """

    rule: str
    outcome: str
    time: float | None
    words: str


@dataclass(frozen=True, slots=True)
class Missing:
    """A signal that the rule lacked, and who might have raised it."""

    signal: str
    words: str
    raisers: tuple[Raiser, ...]


@dataclass(frozen=True, slots=True)
class Moment:
    """Something that befell the rule, for this cause; `rules` are the others that it is about."""

    time: float
    words: str
    rules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class WhyNot:
    """The answer.

    Attributes:
        rule, spike, signal, time: What was asked; the time is when the spike was born (seconds).
        verdict: How far the rule came, at best.
        words: The reason, in a sentence or two.
        at: When that was decided (seconds), if it is.
        clause: By which clause (its number), if it took a spike.
        missing: What it lacked, and who might have raised it.
        moments: What befell it, in order; of more than 200 the first and the last, with one between them that says how
            many are left out.
        whole: Whether the trace reaches back to before the spike; otherwise something may have gone unseen.
    """

    rule: str
    spike: int
    signal: str
    time: float
    verdict: Verdict
    words: str
    at: float | None
    clause: int | None
    missing: tuple[Missing, ...]
    moments: tuple[Moment, ...]
    whole: bool

    def __str__(self) -> str:
        lines = [f"{self.rule}, for {self.signal} at {self.time:.3f} s: {self.words}"]
        for missing in self.missing:
            lines.append(f"  {missing.words}")
            lines += [f"    {raiser.words}" for raiser in missing.raisers]
        lines += [f"  {moment.time:.3f} s: {moment.words}" for moment in self.moments]
        return "\n".join(lines)
