"""A listener's moves (what to do next) in ten conversations that are not among the examples."""

from __future__ import annotations

from quality.measure import labelled
from ravestate.language.examples import bundled
from ravestate.language.moves import Move, bundled_moves
from ravestate.language.normal import normalise
from ravestate.language.sentences import sentences

ROWS = labelled("moves_rows")


def move_of(text: str) -> Move:
    said = sentences(normalise(text).text)
    found = bundled_moves().move(said, asks="?" in " ".join(said))
    assert found is not None
    return found


def test_in_unseen_conversations_half_of_all_moves_and_most_of_the_sure_moves_are_right() -> None:
    bundled_moves().load()
    found = [(wanted, move_of(text)) for text, wanted in ROWS if any(map(str.isalpha, text))]
    right = [wanted == move.name for wanted, move in found]
    sure = [wanted == move.name for wanted, move in found if move.sure]
    either = [wanted in (move.name, move.second) for wanted, move in found]
    print(f"{sum(right) / len(right):.0%} right, {sum(sure) / len(sure):.0%} of the {len(sure)} sure moves")
    assert len(ROWS) >= 190
    assert sum(right) >= 0.48 * len(right)  # even people agree only on two thirds of the moves
    assert sum(either) >= 0.6 * len(either)
    assert sum(sure) >= 0.8 * len(sure)
    assert len(sure) >= 0.15 * len(right)


def test_at_most_three_sentences_of_the_set_are_also_examples() -> None:
    known = {text.lower() for texts in bundled("moves").classes.values() for text in texts}
    shared = {text.lower() for text, _ in ROWS} & known
    assert len(shared) <= 3  # users ask "what do you know about me?" in many conversations
