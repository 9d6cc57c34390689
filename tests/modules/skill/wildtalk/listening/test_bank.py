"""The bank of utterances with replies."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

import pytest

from ravestate.errors import DeclarationError
from ravestate.language.normal import plain
from ravestate.modules.skill.wildtalk.listening.bank import TONES, Bank
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.moment import Moment

ROLES = {"who", "they", "them", "their", "are", "were", "have", "do", "user"}


def entries() -> list[Moment]:
    return list(material().bank.named.values())


def test_every_entry_has_a_reply_that_needs_no_role() -> None:
    lacking = [one.name for one in entries() if all(line.roles for line in one.groups["say"])]
    assert not lacking


def test_replies_use_known_roles_and_agree_with_them() -> None:
    lines = [(one.name, line) for one in entries() for line in one.groups["say"]]
    assert not [place for place, line in lines if line.roles - ROLES]
    assert not [place for place, line in lines if re.search(r"\b(?:was|is|does|has) \{they\}", line.text)]


def test_no_utterance_is_listed_twice() -> None:
    said = Counter(plain(text) for one in material().bank.moments for text in one.examples)
    assert not [text for text, times in said.items() if times > 1]


def test_the_bank_finds_an_entry_by_similar_words(talk: Any) -> None:
    bank = material().bank
    bank.load()
    said = "my dads number is still saved in my phone"
    best = bank.similar([said], said)[0]
    assert "his number is still in my phone" in best.moment.examples
    assert talk.say(said) in [line.text for line in best.moment.groups["say"]]


def test_before_the_model_is_loaded_the_bank_finds_only_equal_words() -> None:
    bank = Bank([("own.tsv:1", "-\tthe kettle sings | it boils\tThen tea.")])
    assert [found.moment.name for found in bank.similar(["The kettle sings!"], "The kettle sings!")] == ["own.tsv:1"]
    assert bank.similar(["the kettle is singing"], "the kettle is singing") == []


@pytest.mark.parametrize(
    "row",
    [
        "happy\ta\tb",
        "-\tonly two columns",
        "-\ta\t",
        "-\t*\tb",
        ">\ta\tb",
        ">>>>\ta\tb",
        "> >\ta\tb",
    ],
)
def test_the_error_about_an_invalid_line_names_the_file_and_the_line(row: str) -> None:
    with pytest.raises(DeclarationError, match=r"own\.tsv:7"):
        Bank([("own.tsv:7", row)])


@pytest.mark.parametrize(("file", "row"), [("own.tsv", ">>\ta\tb"), ("other.tsv", ">\ta\tb")])
def test_the_error_about_a_follow_up_without_an_entry_names_the_file_and_the_line(file: str, row: str) -> None:
    with pytest.raises(DeclarationError, match=rf"{file}:7"):
        Bank([("own.tsv:6", "-\ta\tb"), (f"{file}:7", row)])


def test_a_follow_up_belongs_to_the_nearest_earlier_line_with_one_mark_fewer() -> None:
    rows = ["sad\ta\tA.", ">\tb | c\tB.", ">>\td\tD.", ">\t*\tE.", "-\tf\tF."]
    first, second = Bank([(f"own.tsv:{number}", row) for number, row in enumerate(rows)]).moments
    assert [one.examples for one in first.follows] == [("b", "c"), ("*",)]
    assert [one.examples for one in first.follows[0].follows] == [("d",)]
    assert {one.tone for one in (*first.follows, *first.follows[0].follows)} == {"sad"}
    assert (second.examples, second.follows) == (("f",), ())


def test_every_entry_has_a_known_tone() -> None:
    assert {one.tone for one in entries()} <= {*TONES, ""}
