"""The quiz master repeats a question until an answer comes."""

from examples.loading import example
from ravestate.testing import simulate

quiz = example("quiz_master")


def asked(sim) -> int:
    return sim.fired.count("quiz:ask")


def test_the_question_is_repeated_if_the_user_is_silent() -> None:
    with simulate(quiz) as sim:
        assert sim.said == ["Which planet is nearest to the sun?"]
        sim.advance(50)
        assert asked(sim) == 5  # 10 s until each repetition, and 1 s of patience


def test_an_answer_ends_the_repetition() -> None:
    with simulate(quiz) as sim:
        sim.advance(9)
        sim.say("Mercury, of course.")
        sim.advance(60)
        assert sim.said[-1] == "Mercury it is!"
        assert asked(sim) == 1


def test_after_a_wrong_answer_the_user_can_try_again() -> None:
    with simulate(quiz) as sim:
        sim.say("Venus")
        sim.say("Mercury")
        assert sim.said[-2:] == ["No. Try again.", "Mercury it is!"]


def test_no_spike_is_left_after_the_quiz() -> None:
    with simulate(quiz, settings={"quiz": {"again_after": 2}}) as sim:
        sim.advance(2.5)
        sim.say("mercury")
        sim.advance(60)
        assert sim.snapshot()["spikes"] == []
