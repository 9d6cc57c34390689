"""What the pipeline reads in place of the text."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.meta.nlp.preprocessing import preprocess


@pytest.mark.parametrize(
    "text",
    [
        "I like it",
        "do you like games",
        "I would like tea",
        "My friends like football",
        "Tom and Anna like tea",
        "I don't like tea",
    ],
)
def test_like_is_replaced_where_it_is_a_verb(text: str) -> None:
    assert preprocess(text) == text.replace("like", "have")


@pytest.mark.parametrize(
    "text",
    ["it looks like rain", "she is not like me", "people like you are nice", "I feel like swimming", "and things like that",
     "what is it like", "my aunt, like him", "someone like you", "I likely go", "unlike you"],
)  # fmt: skip
def test_and_left_where_it_is_a_preposition(text: str) -> None:
    assert preprocess(text) == text


@given(
    st.text()
    | st.lists(st.sampled_from(["I", "like", "LIKE", "do", "not", " ", "’", "\x00", "\ud800"])).map("".join)
)
def test_the_copy_is_as_long_as_the_text_and_can_be_encoded(text: str) -> None:
    copy = preprocess(text)
    assert len(copy) == len(text)
    copy.encode()
