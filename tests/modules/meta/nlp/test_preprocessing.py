"""Preprocessing prepares a text for the pipeline."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.meta.nlp.preprocessing import preprocess


@given(
    st.text()
    | st.lists(st.sampled_from(["I", "like", "LIKE", "do", "not", "lol", " ", "’", "\x00", "\ud800"])).map("".join)
)
def test_preprocessing_keeps_the_length_of_a_text_and_makes_it_valid_unicode(text: str) -> None:
    copy = preprocess(text)
    assert len(copy) == len(text)
    copy.encode()
