"""The minimum shares of right answers about the world, on a set that is never used for tuning."""

from __future__ import annotations

from quality import modules


def test_questions_about_the_world_are_answered_and_a_sure_answer_is_seldom_wrong() -> None:
    [result] = modules.results()
    assert result.shares["answered right"] >= 0.50, "\n".join(result.misses)
    assert result.shares["wrong of the sure"] <= 0.05, "\n".join(result.misses)
