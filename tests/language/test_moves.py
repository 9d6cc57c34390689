"""A listener's moves (what to do next), measured on ten conversations that are not among the examples."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravestate.language.examples import bundled
from ravestate.language.moves import Move, Moves, bundled_moves
from ravestate.language.normal import normalise
from ravestate.language.sentences import sentences

TALKS = Path(__file__).parents[1] / "quality" / "moves_rows.tsv"


def move_of(text: str) -> Move:
    said = sentences(normalise(text).text)
    found = bundled_moves().move(said, asks="?" in " ".join(said))
    assert found is not None
    return found


@pytest.fixture(scope="module", autouse=True)
def _loaded() -> None:
    bundled_moves().load()


def test_in_unseen_conversations_about_half_of_all_moves_and_most_of_the_sure_moves_are_right() -> None:
    rows = [line.split("\t") for line in TALKS.read_text(encoding="utf-8").splitlines() if line[:1] not in ("", "#")]
    found = [(wanted, move_of(text)) for text, wanted in rows if any(map(str.isalpha, text))]
    right = [wanted == move.name for wanted, move in found]
    sure = [wanted == move.name for wanted, move in found if move.sure]
    either = [wanted in (move.name, move.second) for wanted, move in found]
    assert len(rows) >= 190
    assert sum(right) >= 0.48 * len(right)  # even people agree only on two thirds of the moves
    assert sum(either) >= 0.6 * len(either)
    assert sum(sure) >= 0.8 * len(sure)
    assert len(sure) >= 0.15 * len(right)


def test_at_most_three_sentences_of_the_set_are_also_examples() -> None:
    rows = {line.split("\t")[0].lower() for line in TALKS.read_text(encoding="utf-8").splitlines()}
    known = {text.lower() for texts in bundled("moves").classes.values() for text in texts}
    assert len(rows & known) <= 3  # users ask "what do you know about me?" in many conversations


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
    said = ("what a wonderful day we had",)
    as_question, as_statement = (bundled_moves().move(said, asks=asks) for asks in (True, False))
    assert as_question is not None
    assert as_statement is not None
    assert as_statement.score > as_question.score


def test_moves_that_are_not_loaded_return_no_move() -> None:
    assert Moves({"greet": ["hello"]}).move(("hello",), asks=False) is None


def test_a_text_without_words_has_no_move() -> None:
    assert bundled_moves().move(("...",), asks=False) is None
    assert bundled_moves().move((), asks=False) is None


def test_only_a_listening_move_with_a_high_score_counts_as_listening() -> None:
    assert Move("console", 0.8, "interest").listens
    assert not Move("console", 0.5, "interest").listens
    assert not Move("fact", 0.9, "recall").listens
