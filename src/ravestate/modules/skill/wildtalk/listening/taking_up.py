"""Replies that take up a statement: its highlight, and a remark or a question that suits its tense and its mood."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravestate.modules.meta.nlp.analysis import Analysis

from .echo import Told, told_in, words_of
from .highlight import highlight_in
from .moment import Line, Moment
from .state import State

OWN = ("once", "not", "might", "plan")
"""Tenses to which only groups of their own reply."""

Groups = list[Sequence[Line]]


@dataclass(frozen=True, slots=True)
class Taken:
    """What the listener takes up of an utterance."""

    told: Told
    """The statement with the highlight; without one, the last statement."""
    highlight: str = ""
    """The phrase that says most, from the agent's view; empty if none stands out."""


def taken_from(seen: Analysis, living: frozenset[str], known: str) -> Taken | None:
    """Return what the listener can take up; None if the utterance tells nothing.

    Args:
        seen: The analysis of the utterance.
        living: The lemmas of nouns for living beings.
        known: The user's words before; they are no news.
    """
    statements = [one for one in seen.sentences if not one.rstrip().endswith("?")]
    told = sorted(told_in(seen, living), key=lambda one: one.start)
    words = {word.index: word for one in statements for word in words_of(seen.tree, one)}
    best = highlight_in(seen, [words[place] for place in sorted(words)], known)
    if best is None:
        return Taken(told[-1]) if told else None
    near = next((one for one in reversed(told) if one.start <= best.start), told[0] if told else Told("", "piece"))
    return Taken(near, best.text)


OFTEN = 0.4
"""The share of questions among the replies to a statement."""
ASKING = {"sad": 0.2, "angry": 0.35, "tired": 0.2}
"""The same in a mood in which questions are a burden."""
UNREPEATED = 12
"""The number of answers for which a question or a remark is not said again."""
ECHOED = 4
"""The least number of answers between two echoes of a whole statement."""


def replies(
    taken: Taken, lines: Mapping[str, Moment], mood: str, state: State, chance: random.Random
) -> Iterator[Groups]:
    """Yield groups of replies: a question or a remark, then the other.

    Args:
        taken: The statement and its highlight.
        lines: The authored lines of taking_up.yaml.
        mood: ``sad``, ``angry``, ``glad``, ``tired``, ``quiet``, or empty.
        state: The state of the talk.
        chance: The source of random choices.
    """
    names = _names(taken.told, mood)
    front = _front(taken, lines, mood, state, chance)
    kinds = ["questions", "remarks" if taken.highlight else "plainly"]
    if chance.random() >= ASKING.get(mood, OFTEN):
        kinds.reverse()
    for kind in kinds:
        yield _framed(lines[kind].lines(*names), front, state)
    if front.text:  # all lines were said lately
        yield [[front]]


def _names(told: Told, mood: str) -> list[str]:
    """Return the names of the groups that reply to a statement, the most specific first."""
    if mood and told.subject != "yours":
        return [f"{mood} {told.tense}", f"{mood} {told.subject}", mood]
    if told.tense in OWN:
        return [f"{told.subject} {told.tense}", told.tense]
    return [f"{told.subject} {told.tense}", told.tense, told.subject, "say"]


def _front(taken: Taken, lines: Mapping[str, Moment], mood: str, state: State, chance: random.Random) -> Line:
    """Return a frame with the highlight or, now and then, with a short statement; an empty line if there is neither."""
    told = taken.told
    lately = any("{told}" in text.lower() for text in state.recent[-ECHOED:])
    if told.subject == "yours":
        return Line("", frozenset())
    if taken.highlight:
        frames = lines["frames"].lines(mood, told.tense, "say")[0]
    elif told.core and not lately:
        frames = lines["echoes"].lines(mood, "say")[0]
    else:
        return Line("", frozenset())
    fresh = [line for line in frames if not any(text.startswith(line.text) for text in state.recent[-3:])]
    return chance.choice(fresh or frames)


def _framed(groups: Sequence[Sequence[Line]], front: Line, state: State) -> Groups:
    """Return phrases with the frame before them, without the phrases that ended a recent answer."""
    return [
        [
            replace(line, text=f"{front.text} {line.text}".strip(), roles=line.roles | front.roles)
            for line in lines
            if not any(text.endswith(line.text) for text in state.recent[-UNREPEATED:])
        ]
        for lines in groups
    ]
