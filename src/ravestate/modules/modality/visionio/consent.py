"""Rules that ask people for permission to remember their faces, store a face after a yes, and forget it on request."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import ravestate as rs
from ravestate.errors import RavestateError
from ravestate.modules import idle, interloc, ontology, rawio, verbaliser
from ravestate.modules.meta.nlp.answer import begins_with_yes, yesno_of
from ravestate.modules.meta.verbaliser.intents import Intent

from . import people
from .names import Settings, agreed, asking, history, left, module, named, refused, visitors, withdrawn
from .visitors import Question, in_front
from .wishes import wish_of

POLITE = 3.0
"""The pause between a person's name and the question whether the agent may remember their face (seconds)."""
ANSWERED = 60.0
"""An answer counts only within this many seconds after the question."""


@module.rule(
    when=named.min_age(POLITE).max_age(None).detached() | idle.bored,
    reads=(visitors, ontology.memory, asking),
    writes=(verbaliser.intent, rawio.output, visitors, asking),
    weight=1.3,  # outranks the other questions that a bored agent asks
    cooldown=20.0,
    detached=True,
    background=True,
)
async def ask_leave(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask a person who has given their name whether the agent may remember their face."""
    if not ctx.settings.ask:
        return rs.Resign("visionio.ask is off")
    memory = ctx[ontology.memory]
    visitor = next(
        (
            visitor
            for visitor in ctx[visitors].values()
            if visitor.item and not visitor.faces and visitor.good(ctx.settings.quality)
        ),
        None,
    )
    if visitor is None or memory is None:
        return rs.Resign("there is nobody to ask, or no memory")
    if _open(ctx) is not None:
        return rs.Resign("the agent has asked another person")
    ctx[visitors].add(visitor.key, replace(visitor, faces=True))
    try:
        present = await memory.together(lambda graph: people.has_faces(graph, visitor.node))
    except RavestateError as error:
        return rs.Resign(f"memory failed: {error}")
    if present:
        return rs.Resign("memory has their face")
    ctx[asking] = Question(visitor.key, ctx.now)
    ctx[verbaliser.intent] = Intent("ask_leave", {"name": visitor.name}, __package__)
    return None


def _open(ctx: rs.RuleContext) -> Question | None:
    """Return the question that still waits for an answer; None if there is none."""
    question = ctx[asking]
    return question if question is not None and ctx.now - question.time <= ANSWERED else None


@module.rule(when=rawio.output.changed.max_age(None).detached(), writes=asking, background=True)
async def overhear(ctx: rs.RuleContext) -> rs.Resign | None:
    """Drop the question when the agent says something else, because a later *yes* may answer those words."""
    question = ctx[asking]
    if question is None or not any(letter.isalpha() for letter in ctx.payload(rawio.output.changed)):
        return rs.Resign("there is no question, or the output has no words")
    ctx[asking] = None if question.said else replace(question, said=True)
    return None


@module.rule(
    when=rawio.input.changed,
    reads=(visitors, history),
    writes=asking,
    emits=(agreed, refused, withdrawn),
)
async def listen(ctx: rs.RuleContext) -> None:
    """Notice an answer to the question, or a user's wish that the agent remember or forget their face."""
    text, question = ctx.payload(rawio.input.changed), _open(ctx)
    wish = await asyncio.to_thread(wish_of, text)
    answer = await asyncio.to_thread(yesno_of, text)
    front = in_front(ctx[visitors], ctx[history])
    if wish:
        ctx.emit(withdrawn if wish == "forget" else agreed, front.key if front else "")
    elif question is not None and answer and not answer.unsure:
        if not answer.no and not begins_with_yes(text):
            return  # "I love it here" is no permission
        ctx.emit(refused if answer.no else agreed, question.key)
    else:
        return
    ctx[asking] = None


REPLIES = (verbaliser.intent, rawio.output, visitors)
"""The slots that a reply writes. `rawio.output` is one of them, so that no other rule answers the same words."""
PRIORITY = 20.0
"""The weight of the reply to a yes, greater than that of small talk. The replies to a no and to *forget my face* have
even more weight."""


@module.rule(when=agreed, reads=ontology.memory, writes=REPLIES, detached=True, weight=PRIORITY)
async def store(ctx: rs.RuleContext) -> None:
    """Store the face vectors (the numbers that identify the face) of a person who agrees."""
    settings: Settings = ctx.settings
    visitor, memory = ctx[visitors].get(ctx.payload(agreed)), ctx[ontology.memory]
    reply, name = "no_memory", visitor.name if visitor else None
    vectors = visitor.good(settings.quality) if visitor else ()
    if visitor is None or not vectors:
        reply = "not_seen"
    elif name is None:
        reply = "no_name"
    elif memory is not None:
        try:
            node, _ = await memory.together(lambda graph: people.keep(graph, visitor.node, vectors, settings.most))
        except RavestateError as error:
            ctx.log.error("%s", error)
        else:
            ctx[visitors].add(visitor.key, replace(visitor, node=node, known=True, faces=True))
            reply = "kept"
    ctx[verbaliser.intent] = Intent(reply, {"name": name}, __package__)


@module.rule(when=refused, writes=REPLIES, detached=True, weight=PRIORITY + 1)
async def respect(ctx: rs.RuleContext) -> None:
    """Accept that a person does not want the agent to remember their face."""
    visitor = ctx[visitors].get(ctx.payload(refused))
    ctx[verbaliser.intent] = Intent("not_kept", {"name": visitor.name if visitor else None}, __package__)


@module.rule(
    when=withdrawn,
    reads=(ontology.memory, interloc.users),
    writes=(*REPLIES, history),
    detached=True,
    weight=PRIORITY + 2,
)
async def forget(ctx: rs.RuleContext) -> None:
    """Remove a person's faces from memory. Without a camera, this works if there is a single user, and the
    agent knows which person in memory they are."""
    visitor, memory = ctx[visitors].get(ctx.payload(withdrawn)), ctx[ontology.memory]
    person, users = visitor.node if visitor is not None else None, list(ctx[interloc.users].values())
    if person is None and len(users) == 1 and isinstance(users[0], interloc.Recognised):
        person = users[0].node
    reply = "not_seen"
    if person is not None:
        try:
            removed = 0 if memory is None else await memory.together(lambda graph: people.forget_faces(graph, person))
            reply = "forgotten" if removed else "had_none"
        except RavestateError as error:
            ctx.log.error("%s", error)
            reply = "no_memory"
        else:
            ctx[history] = ()
            if visitor is not None:
                ctx[visitors].add(visitor.key, replace(visitor, faces=True, vectors=()))  # do not ask again
    ctx[verbaliser.intent] = Intent(reply, {"name": person and person.get("name")}, __package__)


@module.rule(
    when=interloc.forgotten.max_age(None).detached(), reads=ontology.memory, writes=(visitors, history), background=True
)
async def forget_person(ctx: rs.RuleContext) -> None:
    """Treat visitors whom memory has forgotten as strangers."""
    memory = ctx[ontology.memory]
    ctx[history] = ()
    for visitor in ctx[visitors].values():
        if visitor.known and (memory is None or await memory.get(visitor.node.id) is None):
            stranger = replace(visitor, node=ontology.Node("Person"), known=False, faces=True, vectors=())
            ctx[visitors].add(visitor.key, stranger)


@module.rule(when=left.max_age(None).detached(), reads=ontology.memory, background=True)
async def refresh(ctx: rs.RuleContext) -> rs.Resign | None:
    """After a visit, store a new face vector of a person who has agreed earlier, because faces change."""
    settings: Settings = ctx.settings
    visitor, memory = ctx.payload(left), ctx[ontology.memory]
    vectors = visitor.good(max(0.7, settings.quality))[:1]
    if memory is None or not visitor.known or visitor.mistaken or not vectors:
        return rs.Resign("there is nothing to store")

    def file(graph: ontology.Graph) -> None:
        if people.has_faces(graph, visitor.node):
            people.keep(graph, visitor.node.with_properties(), vectors, settings.most)

    try:
        await memory.together(file)
    except RavestateError as error:
        ctx.log.warning("%s", error)
    return None
