"""Replies that take up a statement: they repeat its highlight, and add a remark or a question in its tense and mood."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.tree import SUBJECTS

from .echo import Told, is_astonished, told_in, words_of
from .highlight import highlight_in
from .moment import Line, Moment
from .state import State

OWN = ("once", "not", "might", "plan")
"""Tenses that use only groups with the tense in their name."""

PIECE = 4
"""The maximum number of words of a fragment, with its punctuation, that is dropped beside a sentence: *fair winds!*."""

Groups = list[Sequence[Line]]


@dataclass(frozen=True, slots=True)
class Taken:
    """A statement that the listener takes up, and its highlight."""

    told: Told
    """The statement with the highlight; without one, the last statement."""
    highlight: str = ""
    """The phrase that says most, from the agent's view; empty if none stands out."""
    information: float = 0.0
    """The information of the highlight, in nats."""


def taken_from(seen: Analysis, living: frozenset[str], known: str) -> Taken | None:
    """Return what the listener can take up; None if the utterance tells nothing.

    Args:
        seen: The analysis of the utterance.
        living: The lemmas of nouns for living beings.
        known: The user's previous utterance, whose words are no news.
    """
    statements = [one for one in seen.sentences if not one.rstrip().endswith("?") or is_astonished(seen, one)]
    told = sorted(told_in(seen, living), key=lambda one: one.start)
    parts = [words_of(seen.tree, one) for one in statements]
    full = [part for part in parts if len(part) > PIECE or any(word.dep in SUBJECTS for word in part)]
    words = {word.index: word for part in full or parts for word in part}
    best = highlight_in(seen, [words[place] for place in sorted(words)], known)
    if best is None:
        return Taken(told[-1]) if told else None
    near = next((one for one in reversed(told) if one.start <= best.start), told[0] if told else Told("", "piece"))
    return Taken(near, best.text, best.information)


ALONE, REMARKED = 0.5, 0.75
"""The share of highlights that stand alone, and the share that stand alone or have a remark. The others have a question."""
QUIETLY = 0.8
"""The share of remarks among the replies without a highlight. The rest are questions, of which there are very few."""
TOLD = 5.0
"""The minimum information of a highlight in a sad conversation. A sad user needs to be heard, not to hear lists of things."""
UNREPEATED = 6
"""The number of answers before a question or a remark may be repeated."""


def replies(
    taken: Taken, lines: Mapping[str, Moment], mood: str, state: State, chance: random.Random
) -> Iterator[Groups]:
    """Yield groups of replies, the preferred first.

    Args:
        taken: The statement and its highlight.
        lines: The authored lines of taking_up.yaml.
        mood: ``sad``, ``angry``, ``glad``, ``funny``, ``tired``, ``quiet``, or empty.
        state: The state of the conversation.
        chance: The source of random choices.
    """
    names = _names(taken.told, mood)
    front = _front(taken, lines, mood, state, chance)
    drawn = chance.random()
    if front is None:
        kinds = ["plainly", "questions"] if drawn < QUIETLY else ["questions", "plainly"]
        for kind in kinds:
            yield _framed(lines[kind].lines(*names), NOTHING, state)
        return
    if drawn < ALONE and mood not in ("sad", "quiet", "tired"):
        yield [[front]]
    if drawn >= REMARKED:
        yield _framed(lines["questions"].lines(*names), front, state)
    yield _framed(lines["remarks"].lines(*names), front, state)
    yield [[front]]


NOTHING = Line("", frozenset())


def _names(told: Told, mood: str) -> list[str]:
    """Return the names of the groups that reply to a statement, the most specific first."""
    if mood and told.subject != "yours":
        return [f"{mood} {told.tense}", f"{mood} {told.subject}", mood]
    if told.tense in OWN:
        return [f"{told.subject} {told.tense}", told.tense]
    return [f"{told.subject} {told.tense}", told.tense, told.subject, "say"]


def _front(taken: Taken, lines: Mapping[str, Moment], mood: str, state: State, chance: random.Random) -> Line | None:
    """Return a phrase with a gap for the highlight; None if there is no highlight, or if it does not suit."""
    low = mood == "quiet" and taken.information < TOLD
    if not taken.highlight or low or taken.told.subject == "yours":
        return None
    frames = lines["frames"].lines(mood, taken.told.tense, "say")[0]
    fresh = [line for line in frames if not any(text.startswith(line.text) for text in state.recent[-3:])]
    return chance.choice(fresh or frames)


def _framed(groups: Sequence[Sequence[Line]], front: Line, state: State) -> Groups:
    """Return phrases with `front` before them. Leave out phrases that ended a recent answer."""
    return [
        [
            replace(line, text=f"{front.text} {line.text}".strip(), roles=line.roles | front.roles)
            for line in lines
            if not any(text.endswith(line.text) for text in state.recent[-UNREPEATED:])
        ]
        for lines in groups
    ]
