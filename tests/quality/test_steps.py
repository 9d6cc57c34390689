"""Single steps of understanding are still right for the sentences of their sets."""

from __future__ import annotations

from collections import Counter

import pytest

from quality import measure, steps


@pytest.mark.parametrize("name", steps.SETS)
def test_the_share_of_right_results_stays_above_the_floor(name: str) -> None:
    result = steps.result(name)
    print(f"{name}: {result.shares['right']:.1%} of {result.cases}", *result.misses, sep="\n  ")
    assert result.shares["right"] >= steps.FLOORS[name], "\n".join(result.misses)


@pytest.mark.parametrize("name", steps.SETS)
def test_no_set_has_a_sentence_twice(name: str) -> None:
    counts = Counter(text for text, _ in measure.labelled(name))
    assert [text for text, count in counts.items() if count > 1] == []
