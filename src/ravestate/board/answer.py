"""The explanation of why a rule did not fire, as data (law L25). `ravestate.board.why_not` derives it from a trace.

An explanation is about one rule and one spike. "For the cause" means: in the causal group of this spike. An
*attempt* is one activation of the rule.
"""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.engine.explain import seconds
from ravestate.engine.reasons import Verdict


@dataclass(frozen=True, slots=True)
class Raiser:
    """A rule that may raise a missing signal, and the outcome of its run for the cause.

    Attributes:
        outcome: The outcome of the rule's run, or ``running``, or ``not run``.
        words: The outcome as a sentence.
        time: The time at which the run ended (seconds). Without a run, the time at which the rule's furthest attempt
            stopped. The time is None while the run or the attempt is in progress, or if there was neither.
    """

    rule: str
    outcome: str
    time: float | None
    words: str


@dataclass(frozen=True, slots=True)
class Missing:
    """A signal that the rule lacked, the reason why it was missing (`words`), and the rules that may raise it."""

    signal: str
    words: str
    raisers: tuple[Raiser, ...]


@dataclass(frozen=True, slots=True)
class Moment:
    """Something that happened to the rule for the cause, at `time` (seconds); `rules` are the other rules involved."""

    time: float
    words: str
    rules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class WhyNot:
    """How far a rule got on the way to a run for the cause of a spike, and what stopped the rule.

    Attributes:
        rule: The name of the rule.
        spike: The number of the spike.
        signal: The signal of the spike.
        time: The time of the spike's birth (seconds).
        verdict: The furthest step that an attempt of the rule reached.
        words: The reason for the verdict, as text.
        at: The time at which the verdict was decided (seconds); None while it is undecided.
        clause: The index (from 0) of the furthest attempt's clause; None if there was no attempt.
        missing: The signals that the rule lacked; empty if it lacked none, or if the verdict has another reason.
        moments: The rule's history for the cause. If there are more than 200 moments, one moment takes the place of
            those in the middle.
        whole: Whether the trace reaches back to before the spike; if it does not, the answer may be incomplete.
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
        lines = [f"{self.rule}, for {self.signal} at {seconds(self.time)}: {self.words}"]
        for missing in self.missing:
            lines.append(f"  {missing.words}")
            lines += [f"    {raiser.words}" for raiser in missing.raisers]
        lines += [f"  {seconds(moment.time)}: {moment.words}" for moment in self.moments]
        return "\n".join(lines)
