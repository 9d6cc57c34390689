"""The moves of a listener, on ten whole talks that are kept out of the examples."""

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


def test_about_half_of_the_moves_in_unseen_talks_are_right_and_so_are_most_of_the_sure_moves() -> None:
    rows = [line.split("\t") for line in TALKS.read_text(encoding="utf-8").splitlines() if line[:1] not in ("", "#")]
    found = [(wanted, move_of(text)) for text, wanted in rows if any(map(str.isalpha, text))]
    right = [wanted == move.name for wanted, move in found]
    sure = [wanted == move.name for wanted, move in found if move.sure]
    either = [wanted in (move.name, move.second) for wanted, move in found]
    assert len(rows) >= 190
    assert sum(right) >= 0.48 * len(right)  # even people agree on only two thirds of the moves
    assert sum(either) >= 0.6 * len(either)
    assert sum(sure) >= 0.8 * len(sure)
    assert len(sure) >= 0.15 * len(right)


def test_no_talk_of_the_set_is_among_the_examples() -> None:
    rows = {line.split("\t")[0].lower() for line in TALKS.read_text(encoding="utf-8").splitlines()}
    known = {text.lower() for texts in bundled("moves").classes.values() for text in texts}
    assert len(rows & known) <= 3  # "what do you know about me?" is asked in many talks


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("What did I tell you about my brother?", "recall"),
        ("My uncle died in spring and I miss him.", "mourn"),
        ("Okay, good night, see you tomorrow!", "farewell"),
    ],
)
def test_plain_cases(text: str, name: str) -> None:
    assert move_of(text).name == name


def test_a_statement_asks_for_no_fact() -> None:
    asked = [move_of(text).name for text in ("The bakery has closed.", "We had soup at noon.", "It rained all day.")]
    assert not {"fact", "recall", "self", "opinion"} & set(asked)


def test_the_form_weighs() -> None:
    said = ("what a wonderful day we had",)
    as_question, as_statement = (bundled_moves().move(said, asks=asks) for asks in (True, False))
    assert as_question is not None
    assert as_statement is not None
    assert as_statement.score > as_question.score


def test_before_it_is_loaded_it_knows_nothing() -> None:
    assert Moves({"greet": ["hello"]}).move(("hello",), asks=False) is None


def test_a_text_without_words_has_no_move() -> None:
    assert bundled_moves().move(("...",), asks=False) is None
    assert bundled_moves().move((), asks=False) is None


def test_only_a_sure_move_of_listening_keeps_others_silent() -> None:
    assert Move("console", 0.8, "interest").listens
    assert not Move("console", 0.5, "interest").listens
    assert not Move("fact", 0.9, "recall").listens
