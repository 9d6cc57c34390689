"""The width of a text is estimated, long texts are shortened, and odd characters are replaced."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.text import clean, shorten, width


def test_the_width_of_a_text_depends_on_its_letters() -> None:
    assert width("WWW", 10.0) > width("aaa", 10.0) > width("iii", 10.0) > 0
    assert width("日本", 10.0) > width("ab", 10.0)
    assert width("e\u0301", 10.0) == width("e", 10.0)


@given(st.text(), st.floats(20.0, 300.0))
def test_a_shortened_text_stays_within_the_limit(text: str, limit: float) -> None:
    short = shorten(text, 13.0, limit)
    assert width(short, 13.0) <= limit + 1e-6
    assert short == text or "…" in short


def test_shortening_keeps_the_beginning_and_the_end_of_a_name() -> None:
    short = shorten("first_" + "x" * 100 + "_last", 13.0, 200.0)
    assert short.startswith("first_") and short.endswith("_last")


@pytest.mark.parametrize("bad", ["\x00", "\n", "\ud800", "\ufffe", "\u202e", "\u2028", "\x85"])
def test_control_characters_and_invalid_characters_are_replaced(bad: str) -> None:
    assert clean(f"a{bad}b") == "a\ufffdb"


@given(st.text(st.characters(codec=None)))
def test_cleaned_text_can_be_encoded(text: str) -> None:
    assert clean(clean(text)) == clean(text)
    clean(text).encode("utf-8")
