"""A slip of the tongue: the normal form leaves out the words that the user takes back."""

import pytest

from ravestate.language.normal import normalise
from ravestate.language.slips import slips


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("I live in Bern, I mean Bonn", "I live in Bonn."),
        ("I live in New York I mean New Haven.", "I live in New Haven."),
        ("I'm 34, no 35", "I'm 35."),
        ("I was born in 1980, sorry, 1981 I think.", "I was born in 1981 I think."),
        ("I work as a baker, I mean a butcher.", "I work as a butcher."),
        ("We met. My sister is called Ann, no, Eva!", "We met. My sister is called Eva!"),
    ],
)
def test_words_that_the_user_takes_back_are_left_out(text: str, meant: str) -> None:
    found = normalise(text)
    assert found.text == meant
    assert found.original == text
    assert list(found.origin) == sorted(found.origin)
    last = meant.rstrip(".!").split()[-1]
    start, end = found.span(at := meant.rindex(last), at + len(last))
    assert text[start:end] == last


@pytest.mark.parametrize(
    "text",
    [
        "It's not Bern, sorry, Bonn",
        "I speak French, no German",
        "Anna, sorry, Peter is late",
        "I live in Bern. No, Bonn",
        "is it 5:30, no 6:30",
        "I mean Bonn",
    ],
)
def test_denials_and_other_sentences_are_no_slips(text: str) -> None:
    assert list(slips(text)) == []
