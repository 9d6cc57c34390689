"""The laws of yes and no; `tests/quality` measures which texts mean which."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.modules.meta.nlp.answer import YesNo, yesno_of

MEANINGS = (
    YesNo(2, 0, False),
    YesNo(1, 0, False),
    YesNo(0, 2, False),
    YesNo(0, 1, False),
    YesNo(0, 0, True),
    YesNo(None, None, None),
)


@pytest.mark.parametrize("text", ["yes", "no", "probably not", "of course", "I don't know"])
def test_capitals_spaces_and_marks_change_nothing(text: str) -> None:
    for variant in (
        text.upper(),
        f"  {text} ",
        f"{text}!",
        f"{text}.",
        f"Well, {text}...",
        text.replace("'", "’"),
    ):
        assert yesno_of(variant) == yesno_of(text), variant


def test_an_answer_is_true_and_no_answer_false() -> None:
    assert yesno_of("no") and yesno_of("maybe") and not yesno_of("It is cold.")


words = st.sampled_from(
    sorted({word for text, _ in labelled("yesno_rows") for word in text.split()} | {",", ".", "?", "but", "tree"})
)


@given(st.lists(words, max_size=60).map(" ".join) | st.text(max_size=100))
def test_every_text_has_one_of_six_values(text: str) -> None:
    assert yesno_of(text) in MEANINGS


def test_a_long_text_is_no_more_work_than_a_short_one() -> None:
    assert yesno_of("yes " * 50_000) == MEANINGS[0]
