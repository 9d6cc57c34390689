"""The statement that is taken up, and its kind."""

from __future__ import annotations

from collections import Counter

import pytest

from quality import measure
from ravestate.modules.skill.wildtalk.listening.echo import CORE, told_in
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.taking_up import kind_of, weightiest

from .conftest import seen

FLOOR = 0.9
"""The minimum share of right kinds in taken_rows.tsv: the last result rounded down."""


def kind_in(text: str) -> str:
    phrases = material()
    told = weightiest(told_in(seen(text), phrases.living), phrases.told)
    kind = told and kind_of(told, phrases.told)
    return "-" if told is None else kind.name if kind else "any"


def test_the_weightiest_statement_and_its_kind_are_found() -> None:
    rows = measure.labelled("taken_rows")
    wrong = [(text, label, found) for text, label in rows if (found := kind_in(text)) not in label.split("|")]
    assert 1 - len(wrong) / len(rows) >= FLOOR, wrong
    assert max(Counter(text for text, _ in rows).values()) == 1


def test_an_echo_is_short_and_no_fragment() -> None:
    for text, _ in measure.labelled("taken_rows"):
        for told in told_in(seen(text), material().living):
            assert told.core == "" or 2 < len(told.core.split()) <= CORE + 1, text


@pytest.mark.parametrize("text", ["you can get stamps there", "I know.", "they had", "you could hear the sea at night"])
def test_anybodys_you_and_ellipses_are_not_taken_up(text: str) -> None:
    assert kind_in(text) == "-"
