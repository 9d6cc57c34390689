"""Nonsense is text from hitting the keyboard at random. Rare names are no nonsense."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from quality import measure
from ravestate.language.nonsense import is_nonsense

SETS = ("names_rows", "told_rows", "told_blind_rows", "told_fresh_rows", "told_later_rows", "told_typed_rows")


@pytest.mark.parametrize(
    "text", ["asdfgh", "asdkjh asd", "asdasd", "qwertz uiop", "xkcdbwq", "sdfsdf", "fghj", "aaaaaaa", "dkfjgh sldkfj"]
)
def test_random_letters_are_nonsense(text: str) -> None:
    assert is_nonsense(text)


@pytest.mark.parametrize(
    "text",
    [
        "Werner", "Antwerp", "Afghanistan", "Jasdeep", "Asdrubal", "Schwerdt", "Smrž", "Nguyễn", "Đặng", "Þórdís",
        "Александр", "مريم", "Hirschsprung", "Knightsbridge", "HSBC", "flower power",
    ],
)  # fmt: skip
def test_rare_names_and_other_alphabets_are_no_nonsense(text: str) -> None:
    assert not is_nonsense(text)


@pytest.mark.parametrize("name", SETS)
def test_no_fact_of_the_quality_sets_is_nonsense(name: str) -> None:
    text = (Path(measure.__file__).parent / f"{name}.tsv").read_text(encoding="utf-8")
    values = re.findall(r"=(\w[^;\t\n]*)", text)
    assert len(values) > 50
    assert [value for value in values if is_nonsense(value)] == []
