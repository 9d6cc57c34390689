"""What does an agent cost that has nothing to do?

Processor time of the whole process over some seconds of doing nothing, after one input was answered.
"""

from __future__ import annotations

from collections.abc import Iterable

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare

NONE = 0.001
"""What counts as none: a thousandth of a core."""


def ask(bench: Bench) -> Iterable[Figure]:
    """Ours against the reference implementation, which ticks 20 times a second."""
    seconds = bench.several(5, 3)
    for unrelated in (0, 500):
        ours, theirs = [], []
        for _ in bench.rounds(2, 1):
            ours.append(bench.ours().ask("idle", seconds=seconds, unrelated=unrelated))
            theirs.append(bench.reference().ask("idle", seconds=seconds, unrelated=unrelated))
        figure = compare(
            "idle",
            f"{unrelated or 'no'} rules besides",
            ours,
            "reference implementation",
            theirs,
            unit="core",
        )
        yield _judged(figure)


def _judged(figure: Figure) -> Figure:
    from dataclasses import replace

    assert figure.ours is not None
    return replace(figure, target=f"< {NONE:.1%} of a core", reached=figure.ours.median < NONE)
