"""Laws of the user's moves in the game. The quality set ``charades_rows`` measures how many utterances are understood."""

from __future__ import annotations

from typing import get_args

import pytest

from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.charades.game import Step, moves_of
from ravestate.modules.skill.charades.riddles import RIDDLES
from ravestate.modules.skill.charades.understanding import Move, understand

pytestmark = pytest.mark.usefixtures("reader")

STEPS: tuple[Step, ...] = get_args(Step)


def seen(text: str) -> Analysis:
    return analyse(text, pipeline(""))


def test_an_utterance_is_only_understood_as_a_move_that_is_possible_in_the_step() -> None:
    for text in ("yes", "no", "ready", "stop", "let's play charades", "it was rowing", "what's the score?", "hm", ""):
        heard = seen(text)
        for step in STEPS:
            move = understand(heard, moves_of(step))
            assert move is None or move.kind in moves_of(step), (step, text)


@pytest.mark.parametrize("text", ["what is the capital of Peru?", "who wrote Faust?", "how old are you?"])
def test_a_question_about_something_else_is_no_move(text: str) -> None:
    heard = seen(text)
    assert [step for step in STEPS if understand(heard, moves_of(step)) is not None] == []


@pytest.mark.parametrize("name", RIDDLES)
def test_each_activity_can_be_named(name: str) -> None:
    assert understand(seen(name), moves_of("riddle")) == Move("named", name)
