"""The museum guide answers words and a gesture together."""

import pytest

from examples.loading import example
from ravestate.testing import simulate

museum = example("museum_guide")


@pytest.mark.parametrize("gesture_first", [True, False])
def test_words_and_a_gesture_get_one_answer_whichever_comes_first(gesture_first: bool) -> None:
    with simulate(museum) as sim:
        acts = [lambda: sim.say("What is this?"), lambda: sim.emit(museum.pointed, "pearl")]
        first, second = reversed(acts) if gesture_first else acts
        first()
        sim.advance(0.3)
        second()
        assert sim.said == [museum.PICTURES["pearl"]]
        sim.advance(10)
        assert len(sim.said) == 1


def test_words_without_a_gesture_are_answered_after_the_patience() -> None:
    with simulate(museum) as sim:
        sim.say("Where am I?")
        sim.advance(0.59)
        assert sim.said == []
        sim.advance(0.01)
        assert len(sim.said) == 1


def test_the_head_immediately_turns_to_the_picture_that_the_visitor_points_at() -> None:
    with simulate(museum) as sim:
        sim.emit(museum.pointed, "delft")
        assert sim.read(museum.gaze) == "delft"


def test_the_script_prints_each_answer_with_its_time(capsys: pytest.CaptureFixture[str]) -> None:
    museum.main()
    told = capsys.readouterr().out.splitlines()
    assert [line.split(",")[0] for line in told] == ["0.3 s", "10.9 s"]
