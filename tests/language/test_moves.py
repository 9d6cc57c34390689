"""A listener's moves: what to do next. `tests/quality` measures how many moves are right."""

from __future__ import annotations

import pytest

from ravestate.language import moves
from ravestate.language.moves import Move
from ravestate.language.network import Network, network
from ravestate.language.normal import normalise


def move_of(text: str) -> Move:
    found = moves.move_of(normalise(text).unguessed, asks="?" in text)
    assert found is not None
    return found


@pytest.fixture(scope="module", autouse=True)
def _loaded() -> None:
    network().load()


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("What did I tell you about my brother?", "recall"),
        ("My uncle died in spring and I miss him.", "mourn"),
        ("Okay, good night, see you tomorrow!", "farewell"),
    ],
)
def test_a_clear_utterance_gets_the_right_move(text: str, name: str) -> None:
    assert move_of(text).name == name


def test_a_statement_is_never_taken_for_a_question() -> None:
    asked = [move_of(text).name for text in ("The bakery has closed.", "We had soup at noon.", "It rained all day.")]
    assert not {"fact", "recall", "self", "opinion"} & set(asked)


def test_a_statement_scores_higher_than_a_question_with_the_same_words() -> None:
    said = "what a wonderful day we had"
    as_question, as_statement = (moves.move_of(said, asks=asks) for asks in (True, False))
    assert as_question is not None
    assert as_statement is not None
    assert as_statement.score > as_question.score


def test_before_the_network_is_loaded_there_is_no_move(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Network, "loaded", False)
    assert moves.move_of("hello", asks=False) is None


def test_a_text_without_words_has_no_move() -> None:
    assert moves.move_of("...", asks=False) is None
    assert moves.move_of("", asks=False) is None


def test_only_a_listening_move_with_a_high_score_counts_as_listening() -> None:
    assert Move("console", 0.8, "interest").listens
    assert not Move("console", 0.5, "interest").listens
    assert not Move("fact", 0.9, "recall").listens
