"""The text as the pipeline gets it."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.meta.nlp.preprocessing import preprocess


@given(
    st.text() | st.lists(st.sampled_from(["I", "like", "LIKE", "do", "not", " ", "’", "\x00", "\ud800"])).map("".join)
)
def test_positions_stay_and_the_text_can_be_encoded(text: str) -> None:
    copy = preprocess(text)
    assert len(copy) == len(text)
    copy.encode()
