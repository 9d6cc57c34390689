"""Functions for the rules of small talk: they use the listening skill and the gate, and find notes for the prompt.

The *listening skill* answers with authored phrases. The *gate* checks the sentences of a language model.
"""

from __future__ import annotations

import asyncio
import random
import threading
from contextlib import suppress
from dataclasses import replace
from functools import cache

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, nlp
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline

from .facts import facts_matcher
from .gate import Gate, persona_matcher
from .listening import Answer, Heard, Listener, Overheard, State
from .listening.asking import SHORT
from .listening.grave import is_crisis
from .listening.state import Pending
from .names import clock, history, listening, notes, overheard

LATELY = 12
"""The number of the agent's latest answers that it must not repeat."""
MENTIONED = 4
"""The number of latest utterances that an answer may refer to."""

SORROWFUL = frozenset(("console", "mourn"))
"""Moves (next steps of a good listener) in reply to a sorrow."""
OVERHEARD = 6
"""The number of latest utterances whose tone is kept in `overheard`."""

_TONES = {
    "sad": "The user is sad. Be gentle and brief.",
    "angry": "The user is angry. Stay calm, and take them seriously.",
    "tired": "The user is tired. Be brief.",
}
"""Advice for the model, by the tone of the conversation."""


_making = threading.Lock()


def listener() -> Listener:
    """Return the listening skill, which all contexts share. The first call reads the phrases (0.7 s)."""
    with _making:  # without the lock, two threads may make two listeners; only one would learn the examples
        return _listener()


@cache
def _listener() -> Listener:
    return Listener()


learnt = threading.Event()
"""Set as soon as all examples of small talk are learnt."""


def learn_all() -> None:
    """Learn all examples of small talk.

    Raises:
        PlatformError: The sentence model is missing or broken.
    """
    listener().load()
    facts_matcher().load()
    persona_matcher().load()
    learnt.set()


def heard_in(ctx: rs.RuleContext, text: str, seen: nlp.Analysis | None) -> Heard:
    """Return the utterance in the form that the listening skill takes."""
    users = [item for item in ctx[interloc.users].values() if isinstance(item, str)]
    return Heard(text, seen, users[0] if len(users) == 1 else "")


def may_suit(seen: nlp.Analysis | None) -> bool:
    """Return whether the rule `comfort` may have an answer to the utterance. The rule looks closer, in a thread.

    This predicate runs on the event loop, so it must not compare the utterance with examples, which takes about 20 ms.
    Its other checks would wait for the examples, so it accepts every utterance until the examples are learnt.
    """
    if seen is None or not learnt.is_set():
        return seen is not None
    return may_be_known(seen) or may_need_comfort(seen) or may_claim(seen)


def may_need_comfort(seen: nlp.Analysis) -> bool:
    """Return whether the likely move in reply to the utterance is to comfort the user. `needs_comfort` looks closer."""
    if seen.question is not None or seen.move is None or is_crisis(seen.normal.text):
        return False  # a module with explicit answers to distress comes first
    return bool(SORROWFUL & {seen.move.name, seen.move.second})


def needs_comfort(seen: nlp.Analysis) -> bool:
    """Return whether the user is in sorrow, by the feeling and the likely move. Use a thread: this takes 10 ms."""
    return may_need_comfort(seen) and listener().overhear(seen).tone == "sad"


def may_claim(seen: nlp.Analysis) -> bool:
    """Return whether small talk may have to answer, for example a request for a joke. `claims` looks closer."""
    return listener().claims(Heard(seen.text, seen))


def claims(heard: Heard, state: State) -> bool:
    """Return whether small talk must answer: the user asks for a performance, corrects the agent, or tells news."""
    return listener().claims(heard, state)


def may_be_known(seen: nlp.Analysis) -> bool:
    """Return whether an utterance is a statement to which the listening skill may have a reply. `is_known` looks closer.

    Other skills answer questions, hello and goodbye. A short *yes* or *no* belongs to the module that asked.
    """
    if seen.question is not None or {"greeting", "farewell"} & seen.acts.keys():
        return False
    return not (seen.yesno and len(seen.text.split()) <= SHORT)


def is_known(seen: nlp.Analysis, state: State) -> bool:
    """Return whether the listening skill has a reply to a statement. Use a thread: this takes 10 to 60 ms."""
    skill = listener()
    return may_be_known(seen) and skill.knows(seen, state)


async def listen(ctx: rs.RuleContext, heard: Heard) -> str:
    """Return the answer of the listening skill, and remember it."""
    state = up_to_date(ctx, heard.text)
    answer = await asyncio.to_thread(_answer, heard, state, ctx.random)
    ctx[listening] = answer.state
    return answer.text


def _answer(heard: Heard, state: State, chance: random.Random) -> Answer:
    """Return the listener's answer. If users say their name and something else, answer both.

    The first answer waits until the examples are learnt.
    """
    with suppress(PlatformError):  # the rule `learn` reports the error
        listener().load()
    told = None if heard.seen is None else heard.seen.introduction
    closing = None if heard.seen is None else heard.seen.closing
    if told is None and closing is not None and (closing.remarks or closing.returned):
        asked = Heard(closing.text, analyse(closing.text, pipeline("")), heard.user)
        answer = listener().answer(asked, state, chance)
        return replace(answer, state=replace(answer.state, before=heard.text))
    if told is None or any(told.name in said for said in state.said):
        return listener().answer(heard, state, chance)
    rest = Heard(told.rest, analyse(told.rest, pipeline(""), (), (told.name,)), told.name)
    answer = listener().answer(rest, state, chance)
    if answer.weak:  # the greeting alone is better than a greeting with a phrase that fits everything
        return Answer("", answer.state).opened(f"Hello {told.name}, good to meet you.", heard.text)
    return answer.opened(f"Hello {told.name}.", heard.text)


def is_open(state: State) -> bool:
    """Return whether the skill expects something: a turn in a game, or an answer to its question."""
    return state.game is not None or state.pending is not None


async def follow_up(ctx: rs.RuleContext, heard: Heard) -> str:
    """Return the skill's reply to a turn in a game, or to an answer to its own question; otherwise an empty string."""
    skill = await asyncio.to_thread(listener)
    continues = await asyncio.to_thread(skill.continues, heard, up_to_date(ctx, heard.text))
    return await listen(ctx, heard) if continues else ""


def up_to_date(ctx: rs.RuleContext, text: str) -> State:
    """Return the state of the skill, updated with the utterances that other modules answered.

    Args:
        ctx: The context of the rule.
        text: The utterance to be answered, whose own entry in `overheard` is skipped.
    """
    state = ctx[listening]
    since = list(ctx[overheard])
    answered = [place for place, one in enumerate(since) if one.text == state.before]
    for one in since[answered[-1] + 1 :] if answered else since:
        if one.text != text:
            state = replace(state.toned(one.tone, one.lasts).warned(one.text), before=one.text)
    answers = [message.text for message in ctx[history].values() if message.role == "assistant"]
    words = [answer for answer in answers if any(map(str.isalpha, answer))]
    if words and words[-1:] != list(state.said[-1:]):  # another module has answered since
        asked = Pending(words[-1]) if words[-1].endswith("?") else None
        game = None if state.game is None else state.game.beside(words[-1])
        state = replace(state.having_said(words[-1], words[-1]), pending=asked, game=game)
    return state


def traces(ctx: rs.RuleContext, seen: nlp.Analysis) -> tuple[Overheard, ...]:
    """Return the tone of each of the last utterances, newest last. Any module may have answered them."""
    return (*ctx[overheard][1 - OVERHEARD :], listener().overhear(seen))


def gate_for(ctx: rs.RuleContext, name: str, heard: str) -> Gate:
    """Return the check of a generated answer."""
    messages = list(ctx[history].values())
    said = [message.text for message in messages if message.role == "assistant"]
    return Gate(
        name,
        heard,
        said=said[-LATELY:],
        before=[message.text for message in messages[-MENTIONED:]],
        known={topic: tuple(values) for topic, values in ctx[interloc.facts].items()},
        pipeline=pipeline(""),
    )


def notes_for(ctx: rs.RuleContext, heard: Heard) -> list[str]:
    """Return sentences about the time, the user and the tone, and the notes of other modules, for the prompt."""
    now = ctx[clock]()
    found = [f"It is {now:%A}, {now:%H:%M}."]
    if heard.user and "name" not in ctx[interloc.facts]:
        found.append(f"The user's name is {heard.user}.")
    known = [f"{topic}: {', '.join(values)}" for topic, values in ctx[interloc.facts].items() if values]
    if known:
        found.append(f"What you know about the user: {'; '.join(known)}.")
    state = ctx[listening]
    if state.tone in _TONES:
        found.append(_TONES[state.tone])
    return [*found, *ctx[notes].values()]
