"""What does an idle agent cost?

The figure is the processor time of the whole process over some idle seconds, after one answered input.
"""

from __future__ import annotations

from collections.abc import Iterable

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare

NONE = 0.001
"""The target: an idle agent takes less than this share of a core."""


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare Ravestate with the reference implementation, which ticks 20 times a second."""
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
