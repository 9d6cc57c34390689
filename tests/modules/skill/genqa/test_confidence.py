"""The confidence in an answer is a probability that grows with the evidence for the answer."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.genqa.confidence import confidence

score = st.floats(-12, 12)
share = st.floats(0, 1)


@given(score, share)
def test_confidence_is_a_probability(best: float, covered: float) -> None:
    assert 0 <= confidence(best, covered) <= 1


@given(score, score, share, share)
def test_confidence_grows_with_the_score_and_the_share_of_the_question(a: float, b: float, c: float, d: float) -> None:
    assert confidence(min(a, b), min(c, d)) <= confidence(max(a, b), max(c, d))
