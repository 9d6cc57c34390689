"""Single steps of understanding are still right for the sentences of their sets."""

from __future__ import annotations

from collections import Counter

import pytest

from quality import measure, steps
from ravestate.language import plain
from ravestate.language.matcher import bundled_matcher


@pytest.mark.parametrize("name", steps.SETS)
def test_the_share_of_right_results_stays_above_the_floor(name: str) -> None:
    result = steps.result(name)
    print(f"{name}: {result.shares['right']:.1%} of {result.cases}", *result.misses, sep="\n  ")
    assert result.shares["right"] >= steps.FLOORS[name], "\n".join(result.misses)


@pytest.mark.parametrize("name", steps.SETS)
def test_no_set_has_a_sentence_twice(name: str) -> None:
    counts = Counter(text for text, _ in measure.labelled(name))
    assert [text for text, count in counts.items() if count > 1] == []


def test_hardly_any_performance_starts_unasked() -> None:
    steps.load()
    cases = [case for case in measure.labelled("performances_rows") if case[1] == measure.NONE]
    steps.prepare(text for text, _ in cases)
    result = measure.measure_labels("unasked", steps.performances_rows, cases)
    assert len(result.misses) <= steps.UNASKED * len(cases), "\n".join(result.misses)


def test_the_set_of_performances_has_no_example_of_an_act() -> None:
    examples = bundled_matcher("acts").exact
    assert examples.keys().isdisjoint(plain(text) for text, _ in measure.labelled("performances_rows"))
