"""A figure: what was measured, against what, and whether the target is reached."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass

__all__ = ["Figure", "Spread", "compare", "measured"]


@dataclass(frozen=True, slots=True)
class Spread:
    """The median of some repetitions, and its quartiles."""

    median: float
    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        """The spread of at least one value."""
        ordered = sorted(values)
        if len(ordered) < 2:
            return cls(ordered[0], ordered[0], ordered[0])
        low, median, high = statistics.quantiles(ordered, n=4, method="inclusive")
        return cls(median, low, high)


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the table.

    Attributes:
        question: The name under which the command line knows it.
        what: What was measured.
        unit: "s", "B", "core" (share of one core) or "" (a count).
        ours: Ours, in that unit.
        against: The peer, the floor, or our own other case, that it is compared with.
        theirs: That one's, in the same unit.
        ratio: Ours through theirs, taken in each repetition.
        target: In words; empty where nothing was promised.
        reached: Whether it is; None where nothing was promised.
        failed: Why there is no figure.
    """

    question: str
    what: str
    unit: str = "s"
    ours: Spread | None = None
    against: str = ""
    theirs: Spread | None = None
    ratio: Spread | None = None
    target: str = ""
    reached: bool | None = None
    failed: str = ""


def compare(
    question: str,
    what: str,
    ours: Sequence[float],
    against: str,
    theirs: Sequence[float],
    *,
    unit: str = "s",
    target: str = "",
    reach: Callable[[float], bool] | None = None,
) -> Figure:
    """A figure of repetitions that were taken in turns; the target concerns the ratio."""
    ratio = None
    if all(theirs):
        ratio = Spread.of([one / other for one, other in zip(ours, theirs, strict=True)])
    reached = None if reach is None or ratio is None else reach(ratio.median)
    return Figure(question, what, unit, Spread.of(ours), against, Spread.of(theirs), ratio, target, reached)


def measured(
    question: str,
    what: str,
    ours: Sequence[float],
    *,
    unit: str = "s",
    target: str = "",
    reach: Callable[[float], bool] | None = None,
) -> Figure:
    """A figure of our own; the target concerns the value."""
    spread = Spread.of(ours)
    return Figure(
        question, what, unit, spread, target=target, reached=None if reach is None else reach(spread.median)
    )
