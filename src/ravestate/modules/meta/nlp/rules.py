"""The rules that load the pipeline and analyse the user's words."""

from __future__ import annotations

import asyncio
import contextlib

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.heap import give_back
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import interloc, rawio

from .analysis import MATCHERS, analyse
from .intent import intent_matcher
from .names import (
    Settings,
    about_agent,
    analysis,
    entities,
    intent_bye,
    intent_hi,
    intent_play,
    intents,
    is_question,
    lemmas,
    lock,
    module,
    normal,
    pos,
    question,
    tags,
    text,
    tokens,
    triples,
    yesno,
)
from .pipeline import pipeline

SIGNALS = {"intent_play": intent_play, "intent_hi": intent_hi, "intent_bye": intent_bye}
"""The signals of the user's acts."""


@module.rule(when=rs.startup, background=True)
def load(ctx: rs.RuleContext) -> None:
    """Load the pipeline in the background, before the first words."""
    settings: Settings = ctx.settings
    with contextlib.suppress(PlatformError):  # `understand` reports it
        pipeline(settings.pipeline).load()
        give_back()


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Load the matchers in the background; until then, they know only the examples themselves."""
    try:
        for name in (*MATCHERS, "answers"):
            bundled_matcher(name).load()
        give_back()
    except ModelMissing as error:
        warn_once(ctx.log, error)


@module.rule(when=intents.changed.detached(), reads=intents, background=True)
def learn_intents(ctx: rs.RuleContext) -> None:
    """Learn the examples of the designer's intents in the background."""
    matcher = intent_matcher(ctx[intents].values())
    if matcher is not None:
        with contextlib.suppress(ModelMissing):  # `learn` warns
            matcher.load()


@module.rule(
    when=rawio.input.changed,
    reads=(interloc.agent, interloc.users, intents, lock),
    writes=(text, normal, tokens, lemmas, pos, tags, entities, triples, question, analysis, yesno),
    emits=(is_question, about_agent, *SIGNALS.values()),
)
async def understand(ctx: rs.RuleContext) -> None:
    """Analyse the user's words: write all slots, then raise the signals."""
    settings: Settings = ctx.settings
    heard = ctx.payload(rawio.input.changed)
    named = "agent_names" in settings.model_fields_set
    names = settings.agent_names if named else (ctx[interloc.agent],)
    present = tuple(name for name in ctx[interloc.users].values() if isinstance(name, str))
    designed = await asyncio.to_thread(intent_matcher, tuple(ctx[intents].values()))
    async with ctx[lock]:
        seen = await asyncio.to_thread(analyse, heard, pipeline(settings.pipeline), names, present, designed)
    words = seen.tree.words
    ctx[text] = heard
    ctx[normal] = seen.normal.text
    ctx[tokens] = tuple(word.text for word in words)
    ctx[lemmas] = tuple(word.lemma for word in words)
    ctx[pos] = tuple(word.pos for word in words)
    ctx[tags] = tuple(word.tag for word in words)
    ctx[entities] = seen.entities
    ctx[triples] = seen.triples
    ctx[question] = seen.question
    ctx[analysis] = seen
    ctx[yesno] = seen.yesno
    if seen.question is not None:
        ctx.emit(is_question, seen.question)
    if seen.about_agent:
        ctx.emit(about_agent)
    for name in seen.acted:
        ctx.emit(SIGNALS[name])
