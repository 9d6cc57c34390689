"""Replies that take up a statement: a remark or a question of its kind (told.yaml), seldom with its echo."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from .echo import Told
from .moment import Line, Moment
from .state import Being, State

LATELY = 3
"""The number of answers without an echo before the next one."""
LINKED = 6
"""The number of answers before the listener leads back to somebody again."""
WEIGHTS = {"past": 3.0, "once": 3.0, "plan": 2.5, "not": 2.0, "might": 2.0, "now": 2.0}
"""The weight of a statement of no kind, by its tense: events count more than plans, and plans more than descriptions."""
OWN = ("once", "not", "might")
"""Tenses to which only groups of their own reply."""

Groups = list[Sequence[Line]]


def weightiest(told: Sequence[Told], kinds: Mapping[str, Moment]) -> Told | None:
    """Return the statement that matters most: a feeling before an event, a plan, a description and a side remark.

    Among equals, a statement about people and the later one count more.
    """
    return max(told, key=lambda one: (_weight(one, kinds), one.subject in ("mine", "theirs")), default=None)


def replies(
    told: Told, kinds: Mapping[str, Moment], mood: str, state: State, chance: random.Random, earlier: Being | None
) -> Iterator[tuple[Groups, Moment | None]]:
    """Yield groups of replies: questions, then remarks. A kind of sad statement comes along, for its tone.

    Args:
        told: The statement.
        kinds: The kinds of statements, with their replies.
        mood: ``sad``, ``glad`` or empty.
        state: The state of the talk.
        chance: The source of random choices.
        earlier: Somebody whom the user mentioned before.
    """
    names = _names(told, mood)
    kind = kind_of(told, kinds, mood)
    own = kind.lines(*_names(told, "" if kind.tone == mood else mood)) if kind else []
    general = kinds["any"].lines(*(["glad"] if mood == "glad" else names))
    front = _front(told, kinds, mood, state, chance, own=bool(own))
    sad = kind if kind is not None and kind.tone == "sad" else None
    if earlier is not None and told.subject == "mine" and not mood and _may_link(state) and chance.random() < 0.3:
        yield _framed(kinds["links"].lines(earlier.kind), "", state), sad
    yield _framed([*own, *general], front, state), sad
    notes = ["glad"] if mood == "glad" else ["sad"] if mood else names
    yield _framed(kinds["notes"].lines(*notes), "", state), sad


def kind_of(told: Told, kinds: Mapping[str, Moment], mood: str = "") -> Moment | None:
    """Return the weightiest kind that suits a statement, and has replies for its person, its tense and the mood."""
    verbs, nouns = set(told.verbs), set(told.nouns)
    suiting = [
        one
        for one in kinds.values()
        if one.words and (not one.verbs or one.verbs & verbs) and (not one.nouns or one.nouns & nouns)
    ]
    fit = [one for one in suiting if one.lines(*_names(told, "" if mood and one.tone == mood else mood))]
    return max(fit, key=lambda one: one.weight, default=None)


def _weight(told: Told, kinds: Mapping[str, Moment]) -> float:
    if told.subject == "piece":
        return 0.0
    kind = kind_of(told, kinds)
    return kind.weight if kind is not None and kind.weight else WEIGHTS[told.tense]


def _names(told: Told, mood: str) -> list[str]:
    """Return the names of the groups that reply to a statement, the most specific first."""
    names = [f"{told.subject} {told.tense}", *([] if told.tense in OWN else [told.subject, "say"])]
    return [*(f"sad {name}" for name in names), "sad"] if mood == "sad" else [] if mood else names


def _may_link(state: State) -> bool:
    return len(state.said) > LATELY and not any("{earlier}" in text for text in state.recent[-LINKED:])


def _front(
    told: Told, kinds: Mapping[str, Moment], mood: str, state: State, chance: random.Random, *, own: bool
) -> str:
    """Return a frame for the echo; empty if none may come: the user only answers, or the reply is clear without it."""
    lately = any("{told}" in text.lower() for text in state.recent[-LATELY:])
    if own or lately or not told.core or state.pending is not None:
        return ""
    frames = kinds["frames"].lines(mood, "piece" if told.subject == "piece" else "say")[0]
    return f"{chance.choice(frames).text} "


def _framed(groups: Sequence[Sequence[Line]], front: str, state: State) -> Groups:
    """Return phrases with the frame before them, without the phrases that ended a recent answer."""
    roles = {"told"} if front else set[str]()
    return [
        [
            replace(line, text=front + line.text, roles=line.roles | roles)
            for line in lines
            if not any(text.endswith(line.text) for text in state.recent)
        ]
        for lines in groups
    ]
