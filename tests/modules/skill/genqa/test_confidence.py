"""Confidence is a probability that grows with what speaks for an answer."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.genqa.confidence import WIDEST, confidence, features

score = st.floats(-12, 12)
share = st.floats(0, 1)


@given(score, st.lists(score, max_size=7), share)
def test_it_is_a_probability(best: float, others: list[float], covered: float) -> None:
    assert 0 <= confidence(best, others, covered) <= 1


@given(score, score, share, share)
def test_a_better_score_and_more_of_the_question_make_it_surer(
    a: float, b: float, c: float, d: float
) -> None:
    assert confidence(min(a, b), [], min(c, d)) <= confidence(max(a, b), [], max(c, d))


def test_the_lead_is_that_over_the_next_best_within_bounds() -> None:
    assert features(5.0, [1.0, 3.0], 0.5) == (5.0, 2.0, 0.5)
    assert features(5.0, [], 0.5)[1] == features(5.0, [-11.0], 0.5)[1] == WIDEST
    assert features(5.0, [5.4], 0.5)[1] == 0.0
