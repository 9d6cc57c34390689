"""The rules of persqa. The agent asks the user about themselves, learns from their words, and replies.

An *intent* names what the agent wants to say; the module `verbaliser` puts it into words.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, TypeVar

import ravestate as rs
from ravestate.errors import PlatformError, RavestateError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.loading import wait_for_prompt
from ravestate.modules import idle, interloc, nlp, ontology, rawio, verbaliser

from .acquaintance import Acquaintance, Noted
from .kinds import load as load_examples
from .names import Settings, facts, forgotten, module, noted, reply, talk, told, who
from .recollection import recollect
from .response import respond_to, tells_more
from .talk import TRIES, Talk
from .topics import NAME, due
from .understanding import understand
from .wording import asking, memorable, stating

HELLO = 3.0
"""Seconds from the user's first hello to the agent's question for their name. If the user speaks again in this time,
the agent does not ask."""

T = TypeVar("T")


@module.rule(
    when=idle.bored,
    reads=(who, facts, told),
    writes=(verbaliser.intent, rawio.output, talk),  # the output is here so that no other rule speaks at the same time
    weight=1.2,
    cooldown=20.0,
    detached=True,  # a new causal group, because no rule in the group of `bored` could put the intent into words
)
async def ask(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask the user about themselves, or show that the agent remembers them."""
    settings: Settings = ctx.settings
    now = ctx[talk]
    if now.quiet:
        return rs.Resign("the user has said goodbye")
    if now.asked is not None and (age := ctx.now - now.asked) < settings.gap:
        return rs.Resign(f"a question was asked {age:.0f} s ago; persqa.gap is {settings.gap:g} s")
    if now.question is not None and not now.question.turns:
        now = now.waiting()
    if now.ignored >= settings.ignored:
        return rs.Resign(f"the user left {now.ignored} questions unanswered")
    known = acquaintance_of(ctx).known
    remembered = {name: had for name, had in now.remembered.items() if had and had == known.get(name)}
    if remembered and not now.reminded:  # `remembered` has only facts that still hold
        topic = memorable(remembered, ctx.random)
        values = now.remembered[topic]
        ctx[talk] = replace(now, reminded=True, question=None).mentioning(topic, values)
        ctx[verbaliser.intent] = stating("remind", topic, values, known)
        return None
    if now.moved or (now.busy and now.asked_before):
        return rs.Resign("the user has just shown a feeling, joked, or begun another subject")
    wanted = settings.topics if now.turns >= settings.turns else [one for one in settings.topics if one == NAME]
    topic = due(wanted, known, now.closed, now.tries, last=now.last, touched=now.touched, limit=TRIES)
    if not topic:
        return rs.Resign("there is nothing left to ask")
    ctx[talk] = replace(now.asking(topic, ctx.now), asked=ctx.now)
    ctx[verbaliser.intent] = asking(topic, known)
    return None


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Learn the examples in the background, so that the first utterance does not have to wait."""
    wait_for_prompt()
    try:
        load_examples()
    except ModelMissing as error:
        warn_once(ctx.log, error)


@module.rule(
    when=nlp.intent_hi.min_age(HELLO).max_age(None).detached(),
    reads=(who, facts, told),
    writes=(verbaliser.intent, rawio.output, talk),
    detached=True,
    background=True,
)
async def introduce(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask for the user's name once, after their first hello."""
    settings: Settings = ctx.settings
    now = ctx[talk]
    if ctx[who] is not None or NAME not in settings.topics or NAME in now.closed or now.tries.get(NAME):
        return rs.Resign("the user is known, or was asked for their name already")
    if now.quiet or now.moved or ctx.now - now.spoke < HELLO - 0.1:
        return rs.Resign("the user went on talking, or shows a feeling")
    ctx[talk] = now.asking(NAME, ctx.now)
    ctx[verbaliser.intent] = asking(NAME, acquaintance_of(ctx).known)
    return None


@module.rule(
    when=nlp.analysis.changed,
    reads=ontology.memory,
    writes=(talk, who, facts, told),
    emits=(reply, noted, forgotten),
)
async def listen(ctx: rs.RuleContext) -> None:
    """Learn what users say about themselves, and emit a reply if the agent should reply.

    The slots change before memory saves anything, because the user may speak again before memory has finished.
    `acknowledge` then puts memory's result into the slots.
    """
    settings: Settings = ctx.settings
    seen = ctx.payload(nlp.analysis.changed)
    if seen is None:
        return
    with suppress(PlatformError):  # `learn` reports the error
        await asyncio.to_thread(load_examples)
    before = acquaintance_of(ctx)
    meaning = await asyncio.to_thread(
        understand, seen, before.talk, before.known, ctx.now, settings.within, tuple(before.told.values())
    )
    if meaning.kind == "asked_words":
        words = await asyncio.to_thread(recollect, seen.text, before.talk.words)
        meaning = replace(meaning, words=(words,) if words else ())
    moment, by = datetime.now(UTC), "" if meaning.another else before.name or ""
    meaning = replace(meaning, free=tuple(replace(one, by=by, at=moment) for one in meaning.free))
    response = respond_to(meaning, before, ctx.now, ctx.random, confirm=settings.confirm)
    keep(ctx, before, response.user)
    if response.errand is not None:
        memory, base = ctx[ontology.memory], response.user
        response = await response.errand(memory)
        trouble = response.user.talk.trouble
        is_new = trouble not in ("", base.talk.trouble)
        if is_new and memory is not None and await _is_open(memory):  # otherwise, this fault has already been logged
            ctx.log.error("%s", trouble)
        ctx.emit(noted, Noted(base, response.user, before.name))
        if response.forgotten:
            ctx.emit(forgotten)
    if response.answer is not None and meaning.aloud and not tells_more(response.answer, meaning, seen):
        ctx.emit(reply, response.answer)


async def _is_open(memory: ontology.Memory) -> bool:
    """Return whether memory could be opened; if not, `ontology` logs why."""
    with suppress(RavestateError):
        await memory.opened()
        return True
    return False


@module.rule(when=noted.max_age(None).detached(), writes=(talk, who, facts, told, interloc.users), background=True)
async def acknowledge(ctx: rs.RuleContext) -> None:
    """Put memory's result into the slots, and the user's name into `interloc.users`."""
    base, after, called = ctx.payload(noted)
    now = acquaintance_of(ctx)
    keep(ctx, now, now.rebased(base, after))
    users = ctx[interloc.users]
    if len(users) == 1:
        [(key, item)] = users.items()
        new = item_of(after)
        if (item is None or item == called) and (new, node_id(new)) != (item, node_id(item)):
            users.add(key, new)


@module.rule(
    when=reply,
    writes=verbaliser.intent,
    weight=1.6,  # this rule outranks `agentqa` for "what have you learnt about me?"
)
async def respond(ctx: rs.RuleContext) -> None:
    """Say the reply."""
    ctx[verbaliser.intent] = ctx.payload(reply)


@module.rule(when=rawio.output.changed.max_age(None).detached(), writes=talk, background=True)
async def overhear(ctx: rs.RuleContext) -> rs.Resign | None:
    """Note the agent's latest words. The user's next words may answer these words, and not an earlier question.

    The user's next words may also correct a fact that the agent's words mention.
    """
    words: str = ctx.payload(rawio.output.changed)
    if not any(letter.isalpha() for letter in words):
        return rs.Resign("the output has no word")  # for example, an emoji after an answer
    ctx[talk] = ctx[talk].speaking(words)
    return None


@module.rule(when=rawio.heard.changed.max_age(None).detached(), reads=rawio.output, writes=talk, background=True)
async def notice_unheard_question(ctx: rs.RuleContext) -> rs.Resign | None:
    """Withdraw a spoken question that the user has interrupted. The user's words do not answer this question."""
    said, heard, now = ctx[rawio.output].strip(), ctx.payload(rawio.heard.changed).strip(), ctx[talk]
    if now.question is None or not now.question.fresh:
        return rs.Resign("no question waits for its first answer")
    if heard == said or not said.startswith(heard) or "?" in heard:
        return rs.Resign("the user heard the question")
    ctx[talk] = replace(now, question=None)
    return None


@module.rule(
    when=interloc.users.added.max_age(None).detached() | interloc.recognised.max_age(None).detached(),
    reads=(ontology.memory, interloc.users),
    writes=(talk, who, facts, told),
    emits=noted,
    background=True,
)
async def welcome(ctx: rs.RuleContext) -> rs.Resign | None:
    """Look up a user in memory who arrives, or whom the platform recognises.

    `hibye` greets them; later, in a silence, `ask` mentions a known fact.
    """
    if len(ctx[interloc.users]) > 1:
        return rs.Resign("another user is already present")
    before = acquaintance_of(ctx)
    person = person_of((ctx.payload(interloc.users.added) or ctx.payload(interloc.recognised)).item)
    if person is None or before.name == person[NAME]:
        user = before
    elif before.who is None:
        user = replace(before, who=person)
    else:
        user = Acquaintance(person, {}, Talk())
    await begin(ctx, replace(user, talk=replace(user.talk, quiet=False)))
    return None


@module.rule(
    when=interloc.users.removed.max_age(None).detached(),
    reads=(ontology.memory, interloc.users),
    writes=(talk, who, facts, told),
    emits=noted,
    background=True,
)
async def part(ctx: rs.RuleContext) -> rs.Resign | None:
    """Reset the state of the conversation when the user leaves. If one other user stays, begin a conversation with them."""
    left, known = person_of(ctx.payload(interloc.users.removed).item), ctx[who]
    others = list(ctx[interloc.users].values())
    if len(others) > 1 or (others and (left is None or known is None or left[NAME] != known[NAME])):
        return rs.Resign("the user, or more than one other user, is still present")
    person = person_of(others[0]) if others else None
    await begin(ctx, Acquaintance(person, {}, Talk(quiet=not others)))
    return None


def item_of(user: Acquaintance) -> str | None:
    """Return the item for a user in `interloc.users`: their name, and also their node if their identity is certain.

    Return None while the name is not known.
    """
    return user.name if user.who is None or user.talk.doubt else interloc.Recognised(user.who[NAME], user.who)


def node_id(item: object) -> str | None:
    """Return the id of the node in an item of `interloc.users`; None if the item has no node."""
    return item.node.id if isinstance(item, interloc.Recognised) else None


def person_of(item: object) -> ontology.Node | None:
    """Return the person of an item in `interloc.users`; None for an item without a name."""
    item = getattr(item, "node", item)  # a platform that recognises people gives a node
    if isinstance(item, ontology.Node):
        return item if item.get(NAME) else None
    return ontology.Node("Person", {NAME: item.strip()}) if isinstance(item, str) and item.strip() else None


async def begin(ctx: rs.RuleContext, user: Acquaintance) -> None:
    """Begin a conversation with this user, and ask memory about them."""
    keep(ctx, acquaintance_of(ctx), user)
    memory = ctx[ontology.memory]
    if memory is None or user.who is None:
        return
    try:
        after = await memory.together(user.recall)
    except RavestateError as error:
        ctx.log.error("%s", error)
    else:
        ctx.emit(noted, Noted(user, after, after.name))


def acquaintance_of(ctx: rs.RuleContext) -> Acquaintance:
    """Return the user as the slots describe them."""
    return Acquaintance(ctx[who], dict(ctx[facts]), ctx[talk], dict(ctx[told]))


def keep(ctx: rs.RuleContext, before: Acquaintance, after: Acquaintance) -> None:
    """Write to the slots all that differs between `before` and `after`."""
    if after.who != before.who:
        ctx[who] = after.who
    if after.talk != before.talk:
        ctx[talk] = after.talk
    _update(ctx[facts], before.facts, after.facts)
    _update(ctx[told], before.told, after.told)


def _update(items: Any, before: Mapping[str, T], after: Mapping[str, T]) -> None:
    for key in [key for key in before if key not in after]:
        items.remove(key)
    for key, value in after.items():
        if before.get(key) != value:
            items.add(key, value)


@module.rule(
    when=facts.changed.max_age(None).detached() | who.changed.max_age(None).detached(),
    reads=(facts, who),
    writes=interloc.facts,
    background=True,
)
async def publish(ctx: rs.RuleContext) -> None:
    """Copy the facts about the user, and their name, to `interloc.facts`, for modules that do not require persqa."""
    known = {
        topic: tuple(values)
        for topic, values in Acquaintance(ctx[who], dict(ctx[facts]), Talk()).known.items()
        if values
    }
    _update(ctx[interloc.facts], dict(ctx[interloc.facts]), known)
