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
from .names import (
    Settings,
    about_agent,
    analysis,
    entities,
    intent_bye,
    intent_hi,
    intent_play,
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


@module.rule(
    when=rawio.input.changed,
    reads=(interloc.agent, lock),
    writes=(text, normal, tokens, lemmas, pos, tags, entities, triples, question, analysis, yesno),
    emits=(is_question, about_agent, intent_play, intent_hi, intent_bye),
)
async def understand(ctx: rs.RuleContext) -> None:
    """Analyse the user's words: write all slots, then raise the signals."""
    settings: Settings = ctx.settings
    heard = ctx.payload(rawio.input.changed)
    named = "agent_names" in settings.model_fields_set
    names = settings.agent_names if named else (ctx[interloc.agent],)
    async with ctx[lock]:
        seen = await asyncio.to_thread(analyse, heard, pipeline(settings.pipeline), names)
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
    if seen.intent_play:
        ctx.emit(intent_play)
    if seen.intent_hi:
        ctx.emit(intent_hi)
    if seen.intent_bye:
        ctx.emit(intent_bye)
