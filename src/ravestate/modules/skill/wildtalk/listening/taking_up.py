"""Replies that take up a statement: its echo, and a question of its kind (told.yaml)."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from .echo import Told
from .moment import Line, Moment
from .state import State

LATELY = 3
"""The number of last answers whose frames do not come again."""

Groups = list[Sequence[Line]]


def replies(
    told: Told, kinds: Mapping[str, Moment], mood: str, state: State, chance: random.Random
) -> Iterator[tuple[Groups, Moment | None]]:
    """Yield groups of replies: questions, then signs of listening. A kind of sad statement comes along, for its tone.

    Args:
        told: The statement.
        kinds: The kinds of statements, with their questions.
        mood: ``sad``, ``glad`` or empty.
        state: The state of the talk.
        chance: The source of random choices.
    """
    names = (f"{told.subject} {told.tense}", told.subject)
    kind = _kind(told, kinds, mood, names)
    own = kind.lines(*names) if kind else []
    general = kinds["any"].lines(*([mood] if mood else names))
    frames = kinds["frames"].lines(mood, "piece" if told.subject == "piece" else "say")[0]
    echoed = "{told}" in "".join(state.recent[-1:]).lower()  # not twice running, if the question itself takes it up
    asking = _framed(own, [] if echoed else frames, state, chance) + _framed(general, frames, state, chance)
    yield asking, kind if kind is not None and kind.tone == "sad" else None
    yield _framed(kinds["notes"].lines(mood, "say"), kinds["frames"].lines(mood, "notes")[0], state, chance), None


def _kind(told: Told, kinds: Mapping[str, Moment], mood: str, names: Sequence[str]) -> Moment | None:
    """Return the first kind with a verb or an adjective of a statement, and with questions about its subject."""
    if told.tense in ("once", "not", "might"):
        return None
    found = (one for verb in told.verbs for one in kinds.values() if verb in one.words and one.lines(*names))
    return next((one for one in found if not mood or one.tone == mood), None)


def _framed(groups: Sequence[Sequence[Line]], frames: Sequence[Line], state: State, chance: random.Random) -> Groups:
    """Return phrases with one of the frames before them, without the phrases that ended a recent answer."""
    recent = state.recent[-LATELY:]
    fresh = [one.text for one in frames if not any(text.startswith(one.text) for text in recent)]
    front = f"{chance.choice(fresh)} " if fresh else ""
    roles = {"told"} if front else set[str]()
    return [
        [
            replace(line, text=front + line.text, roles=line.roles | roles)
            for line in lines
            if not any(text.endswith(line.text) for text in state.recent)
        ]
        for lines in groups
    ]
