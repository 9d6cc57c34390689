"""A figure: the measurement, its comparison, and its target."""

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
        """Return the spread of at least one value."""
        ordered = sorted(values)
        if len(ordered) < 2:
            return cls(ordered[0], ordered[0], ordered[0])
        low, median, high = statistics.quantiles(ordered, n=4, method="inclusive")
        return cls(median, low, high)


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the table.

    Attributes:
        question: The question's name on the command line.
        what: The measured quantity.
        unit: "s", "B", "core" (a share, for example of one core) or "" (a count).
        ours: Our figure, in that unit.
        against: The peer, the floor, or another case of ours, for comparison.
        theirs: The figure of `against`, in the same unit.
        ratio: Ours divided by theirs, taken in each repetition; None without a comparison, or if theirs is 0.
        target: The target in words; empty without a claim.
        reached: Whether the target is reached; None without a claim.
        failed: The reason why there is no figure; empty if there is one.
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
    """Return a figure that compares two contestants; the target concerns the ratio."""
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
    """Return a figure of Ravestate alone; the target concerns the value."""
    spread = Spread.of(ours)
    return Figure(question, what, unit, spread, target=target, reached=None if reach is None else reach(spread.median))
