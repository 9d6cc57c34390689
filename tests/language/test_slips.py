"""A slip of the tongue: the normal form leaves out the words that the user takes back."""

import pytest

from ravestate.language.normal import normalise
from ravestate.language.slips import slips


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("I live in Bern, I mean Bonn", "I live in Bonn."),
        ("I live in New York, I mean New Haven.", "I live in New Haven."),
        ("I'm 34, no 35", "I'm 35."),
        ("I was born in 1980, sorry, 1981 I think.", "I was born in 1981 I think."),
        ("I work as a baker, I mean a butcher.", "I work as a butcher."),
        ("We met. My sister is called Ann, no, Eva!", "We met. My sister is called Eva!"),
        ("it costs 3.50, no, 4 euros", "It costs 4 euros."),
        ("it costs 3.50 euros, no 4 euros", "It costs 4 euros."),
        ("we paid 1,000, no, 2,000 euros", "We paid 2,000 euros."),
        ("we paid 1,000, no 2,000", "We paid 2,000."),
        ("from 9:30, no 10", "From 10."),
        ("I get up at 5:30, no 6:30", "I get up at 6:30."),
        ("I have 2 children, no 3 children", "I have 3 children."),
        ("I visited Rome, no, Bern, no, Bonn.", "I visited Bonn."),
        ("I'm 34, no 35, no 36", "I'm 36."),
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
        "I have 2, no 1 told me why",
        "I scored 10, no 2 of us scored 10",
        "there were 10, no 2 alike",
        "I have 10 books, no 2 books are alike",
        "I have room 5, no 3 is taken",
        "I have 2, no 1,000 of us told me why",
        "it costs 3.50, no 4 euros",
        "we paid 1,000, no 2,000 euros",
        "I told Anna I meant Peter.",
        "I came from Bern, sorry, Mum.",
        "I mean Bonn",
    ],
)
def test_denials_and_other_sentences_are_no_slips(text: str) -> None:
    assert list(slips(text)) == []
