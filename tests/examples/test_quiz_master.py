"""The quiz master: a loop of prompts, ended by an answer."""

from examples.loading import example
from ravestate.testing import simulate

quiz = example("quiz_master")


def asked(sim) -> int:
    return sim.fired.count("quiz:ask")


def test_in_silence_the_question_is_repeated() -> None:
    with simulate(quiz) as sim:
        assert sim.said == ["Which planet is nearest to the sun?"]
        sim.advance(50)
        assert asked(sim) == 5  # every 10 s, and 1 s of patience for an answer each time


def test_an_answer_ends_the_loop() -> None:
    with simulate(quiz) as sim:
        sim.advance(9)
        sim.say("Mercury, of course.")
        sim.advance(60)
        assert sim.said[-1] == "Mercury it is!"
        assert asked(sim) == 1


def test_a_wrong_answer_opens_the_question_once_more() -> None:
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
