"""A `Line` is a priority queue: it returns its places in sorted order, not in the order in which they joined."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from ravestate.engine.line import Line

numbers = st.integers(0, 20)


@given(st.lists(st.one_of(st.lists(numbers), st.just("pop"))))
def test_the_least_place_comes_first(steps: list[list[int] | str]) -> None:
    line = Line()
    model: list[int] = []
    for step in steps:
        if isinstance(step, list):
            line.join([(number,) for number in step])
            model = sorted([*model, *step])
        elif model:
            assert line.take() == (model.pop(0),)
        assert bool(line.line) == bool(model)
    line.clear()
    assert not line.line
