"""The rules of agentqa. The agent answers questions and remarks, and offers to talk about itself."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import replace

import ravestate as rs
from ravestate.errors import PlatformError, RavestateError, RuleError
from ravestate.language.acts import acts
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.loading import wait_for_prompt
from ravestate.modules import idle, interloc, nlp, ontology, rawio, verbaliser
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QuestionWord
from ravestate.modules.meta.verbaliser.intents import Intent

from .itself import recall, settle
from .life import Fact, Life
from .life_file import read_life
from .names import Settings, asked, clock, life, module, mood, prompted, remarked, turns
from .remarks import act_in, remark_in
from .router import Match, Miss, router_of
from .telling import telling, without_question

CERTAIN = 0.7
"""The least confidence of the topic of a question, if the utterance also seems to call for another kind of reply."""
STATED = 0.85
"""The same as `CERTAIN`, for a statement. It is higher, because a statement may resemble a question: *I don't know what
to say*."""
STRAY = 0.9
"""The least confidence at which the agent accepts the topic of a question for advice. This threshold is for questions
that do not mention the agent: *what if I forget my lines*."""
_OWN = frozenset(("what_if", "how_to", "should", "say_what", "recommend", "worth", "predict"))
"""Kinds of questions (asks.yaml) about the user's own life."""
_YOU = frozenset(("you", "your", "yours", "yourself"))
TURNS = 6
"""The number of utterances that a user makes before the agent invites questions about itself."""


@module.rule(when=rs.startup.detached(), writes=(life, interloc.agent), detached=True)
async def be_born(ctx: rs.RuleContext) -> None:
    """Read the agent's life from the files, and publish the agent's name."""
    settings: Settings = ctx.settings
    told = read_life(settings.life)
    ctx[interloc.agent] = told.name
    ctx[life] = told


@module.rule(when=life.changed.detached(), background=True)
def load(ctx: rs.RuleContext) -> None:
    """Learn the topics in the background, so that the first question does not have to wait."""
    wait_for_prompt()
    told = ctx.payload(life.changed)
    if told is not None:
        with contextlib.suppress(PlatformError):  # the first question raises the error again
            try:
                router_of(told).load()
            except ModelMissing as error:
                warn_once(ctx.log, error)


@module.rule(when=life.changed.detached(), reads=ontology.memory, background=True)
async def remember(ctx: rs.RuleContext) -> rs.Resign | None:
    """Save the facts of the agent's life in memory."""
    told, memory = ctx.payload(life.changed), ctx[ontology.memory]
    if told is None or memory is None:
        return rs.Resign("there is no memory, or no life")
    try:
        await memory.opened()
    except RavestateError:
        return rs.Resign("memory cannot be opened")
    try:
        await settle(told, memory)
    except RuleError as error:
        return rs.Resign(str(error))  # memory was closed meanwhile: the conversation is over
    except RavestateError as error:
        ctx.log.warning("the agent's facts in memory may be out of date: %s", error)
    return None


@module.rule(when=nlp.analysis.changed, reads=(life, idle.asked), emits=asked)
async def understand(ctx: rs.RuleContext) -> rs.Resign | None:
    """Notice a question about the agent, and its topic."""
    told, seen = ctx[life], ctx.payload(nlp.analysis.changed)
    if told is None or seen is None:
        return rs.Resign("the agent has no life yet, or nothing was said")
    if seen.question is None and seen.move is not None and seen.move.listens:
        return rs.Resign(f"the user wants to be listened to, and asks nothing: {seen.move.name}")
    route = router_of(told).route
    found: Match | Miss = Miss("")
    if ctx[idle.asked] and await asyncio.to_thread(_returns, seen):
        found = await asyncio.to_thread(route, ctx[idle.asked], question=True)
    if isinstance(found, Match):
        found = replace(found, returned=True)
    else:
        text = seen.normal.text if seen.closing is None else seen.closing.text
        found = await asyncio.to_thread(route, text, question=seen.question is not None)
    if isinstance(found, Miss):
        return rs.Resign(found.reason)
    leave = "permit" in seen.asks and seen.question is not QuestionWord.OBJECT  # "what can I call you" asks for a name
    if (leave or "choose" in seen.asks) and " or " not in found.example:
        return rs.Resign("the user names options to choose from, or asks for permission")
    own = _YOU.isdisjoint(found.question.split()) and not _OWN.isdisjoint(seen.asks)
    if own and found.score < STRAY:
        return rs.Resign(f"the user asks about their own life, not about the agent: {', '.join(seen.asks)}")
    certain = CERTAIN if seen.question is not None or "?" in seen.text else STATED
    if seen.move is not None and found.score < certain and "self" not in (seen.move.name, seen.move.second):
        reason = f"{found.topic} is only likely, and the utterance calls for another kind of reply: {seen.move.name}"
        return rs.Resign(reason)
    ctx.log.debug("%s", found)
    ctx.emit(asked, found)
    return None


@module.rule(when=rawio.input.changed, reads=(life, turns), writes=turns, emits=remarked)
def heed(ctx: rs.RuleContext) -> None:
    """Count the utterance. Notice a remark by its words alone: distress gets an answer even without sentence models.

    The rule runs in a thread, because it waits for the normal form and the encoder.
    """
    told, (count, _) = ctx[life], ctx[turns]
    ctx[turns] = (count + 1, ctx.now)
    found = None if told is None else remark_in(ctx.payload(rawio.input.changed), told)
    if found is not None:
        ctx.emit(remarked, found)


@module.rule(when=nlp.analysis.changed, reads=life, emits=remarked)
async def heed_act(ctx: rs.RuleContext) -> rs.Resign | None:
    """Notice a remark by its meaning, such as an insult."""
    told, seen = ctx[life], ctx.payload(nlp.analysis.changed)
    if told is None or seen is None or remark_in(seen.text, told) is not None:
        return rs.Resign("there is no life, or `heed` has noticed the remark")
    found = act_in(seen, told)
    if found is None:
        return rs.Resign("the utterance is not a remark that the agent responds to, such as an insult")
    ctx.emit(remarked, found)
    return None


@module.rule(
    when=remarked,
    reads=(life, mood, clock),
    writes=verbaliser.intent,
    weight=25.0,  # this rule outranks nearly all rules of other modules, even those that answer a question
)
async def respond(ctx: rs.RuleContext) -> None:
    """Answer the remark."""
    told, remark = ctx[life], ctx.payload(remarked)
    assert told is not None  # without a life, no rule emits `remarked`
    phrases = telling(told.topics[remark.topic], remark.text, told.facts, mood=ctx[mood], now=ctx[clock]())
    if phrases is not None:
        ctx[verbaliser.intent] = intent(remark.topic, phrases)


@module.rule(when=idle.hushed, writes=verbaliser.intent, weight=20.0)  # only the answer to a remark outranks this rule
async def keep_quiet(ctx: rs.RuleContext) -> None:
    """Promise to be quiet; `idle` keeps the promise."""
    ctx[verbaliser.intent] = Intent("hushed", package=__package__)


@module.rule(
    when=asked,
    reads=(life, mood, clock, ontology.memory),
    writes=verbaliser.intent,
    weight=1.5,  # this rule outranks other modules that answer the same question
)
async def answer(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer the question."""
    match, told = ctx.payload(asked), ctx[life]
    assert told is not None  # without a life, no rule emits `asked`
    facts = await known(ctx, told, ctx[ontology.memory])
    phrases = telling(told.topics[match.topic], match.question, facts, mood=ctx[mood], now=ctx[clock]())
    if phrases is None:
        return rs.Resign(f"I don't know what to say about {match.topic}: its phrases lack a fact")
    if match.returned:
        phrases = [without_question(phrase) for phrase in phrases]
    ctx[verbaliser.intent] = intent(match.topic, phrases)
    return None


@module.rule(
    when=idle.bored.min_age(Settings.prompt_after).max_age(None),
    reads=(prompted, turns, idle.unanswered),
    # The rule also takes the output, so that no other rule speaks at the same time.
    writes=(verbaliser.intent, rawio.output, prompted),
    weight=0.9,
    # The intent starts a causal group of its own. In the group of `bored`, this rule has taken `rawio.output`, so the
    # verbaliser could not write the output.
    detached=True,
)
async def offer(ctx: rs.RuleContext) -> rs.Resign | None:
    """After a long silence, invite the user to ask about the agent. Do so once, after at least `TURNS` utterances."""
    count, last = ctx[turns]
    if ctx[prompted] is not None or count < TURNS:
        return rs.Resign("the agent has made this offer before, or the conversation has just begun")
    if ctx.now - last < ctx.settings.prompt_after or ctx[idle.unanswered]:
        return rs.Resign("the user has spoken, or owes an answer")
    ctx[prompted] = ctx.now
    ctx[verbaliser.intent] = Intent("ask_me", package=__package__)
    return None


def _returns(seen: Analysis) -> bool:
    """Return whether the user asks the agent's own question back: *and you?*, or *sailing, and you?*."""
    last = seen.sentences[-1].rpartition(", ")[2] if seen.sentences else ""
    return seen.act("return_question") is not None or "return_question" in acts([last])


def intent(topic: str, phrases: Sequence[str]) -> Intent:
    """Return an intent with these phrases, whose facts are already filled in. Escape the braces that facts contain."""
    texts = [phrase.replace("{", "{{").replace("}", "}}") for phrase in phrases]
    return Intent(f"agentqa:{topic}", phrases={"en": texts})


async def known(ctx: rs.RuleContext, told: Life, memory: ontology.Memory | None) -> Mapping[str, Fact]:
    """Return the agent's facts from memory. If there is no memory, or if it fails, return them from the file."""
    if memory is None:
        return told.facts
    try:
        return {**await recall(told, memory), "memory": "my memory"}
    except RavestateError as error:
        ctx.log.warning("memory does not answer, so the agent uses the file: %s", error)
        return told.facts
