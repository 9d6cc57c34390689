"""The rules that load the pipeline and analyse the user's words."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Sequence

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.loading import wait_for_prompt
from ravestate.language.matcher import Matcher
from ravestate.modules import interloc, rawio

from . import names
from .analysis import Analysis, analyse, load_models
from .intent import intent_matcher
from .names import Settings, module
from .pipeline import Pipeline, pipeline
from .reading import Reading, model_reader

SIGNALS = {"intent_play": names.intent_play, "intent_hi": names.intent_hi, "intent_bye": names.intent_bye}
"""Name → signal, for three acts of the user: they want to play, greet, or say goodbye."""


@module.rule(when=rs.startup, background=True)
def load(ctx: rs.RuleContext) -> None:
    """Load the pipeline in the background, before the user's first words."""
    wait_for_prompt()
    settings: Settings = ctx.settings
    with contextlib.suppress(PlatformError):  # `understand` reports the error
        pipeline(settings.pipeline).load()


@module.rule(when=rs.startup, background=True)
def learn(ctx: rs.RuleContext) -> None:
    """Load the classifiers of sentences in the background, so that the first utterance does not wait for them."""
    wait_for_prompt()
    try:
        load_models()
    except ModelMissing as error:
        warn_once(ctx.log, error)


@module.rule(when=names.intents.changed.detached(), reads=names.intents, background=True)
def learn_intents(ctx: rs.RuleContext) -> None:
    """Learn the examples of the designer's intents (signals that examples define) in the background."""
    matcher = intent_matcher(ctx[names.intents].values())
    if matcher is not None:
        with contextlib.suppress(ModelMissing):  # `learn` has logged the warning
            matcher.load()


@module.rule(when=rs.startup, writes=names.reader)
def connect(ctx: rs.RuleContext) -> rs.Resign | None:
    """Prepare a reader with the language model that the settings name."""
    settings: Settings = ctx.settings
    if not settings.model or ctx[names.reader] is not None:
        return rs.Resign("the settings name no model, or the designer has written a reader")
    ctx[names.reader] = model_reader(settings.model, settings.base_url, settings.api_key, settings.model_timeout)
    return None


@module.rule(when=rs.shutdown, reads=names.reader)
async def disconnect(ctx: rs.RuleContext) -> None:
    """Close the connections to the language model."""
    if (reader := ctx[names.reader]) is not None:
        await reader.close()


def analysed(
    text: str,
    parser: Pipeline,
    called: Sequence[str],
    present: Sequence[str],
    designed: Matcher | None,
    reading: Reading | None = None,
) -> Analysis:
    """Return the analysis of a text, as `analyse` does. The first text waits until the models are loaded."""
    with contextlib.suppress(PlatformError):  # `learn` reports the error
        load_models()
    return analyse(text, parser, called, present, designed, reading)


async def read(ctx: rs.RuleContext, text: str) -> Reading | None:
    """Return the language model's reading of a text; None without a model, or if the model fails."""
    reader = ctx[names.reader]
    try:
        return None if reader is None else await reader.read(text)
    except PlatformError as error:
        ctx.log.warning("%s", error)
        return None


@module.rule(
    when=rawio.input.changed,
    reads=(interloc.agent, interloc.users, names.intents, names.lock, names.reader),
    writes=(
        names.text,
        names.normal,
        names.tokens,
        names.lemmas,
        names.pos,
        names.tags,
        names.entities,
        names.triples,
        names.question,
        names.analysis,
        names.yesno,
    ),
    emits=(names.is_question, names.about_agent, *SIGNALS.values()),
)
async def understand(ctx: rs.RuleContext) -> None:
    """Analyse the user's words: write all slots, then raise the signals."""
    settings: Settings = ctx.settings
    heard = ctx.payload(rawio.input.changed)
    named = "agent_names" in settings.model_fields_set
    called = settings.agent_names if named else (ctx[interloc.agent],)
    present = tuple(name for name in ctx[interloc.users].values() if isinstance(name, str))
    intents, parser = tuple(ctx[names.intents].values()), pipeline(settings.pipeline)
    async with ctx[names.lock]:  # take the lock before any thread runs: threads do not keep the order of utterances
        designed = await asyncio.to_thread(intent_matcher, intents)
        reading = asyncio.create_task(read(ctx, heard))
        try:
            seen = await asyncio.to_thread(analysed, heard, parser, called, present, designed)
            if (found := await reading) is not None:
                seen = await asyncio.to_thread(analysed, heard, parser, called, present, designed, found)
        finally:
            reading.cancel()
    words = seen.tree.words
    ctx[names.text] = heard
    ctx[names.normal] = seen.normal.text
    ctx[names.tokens] = tuple(word.text for word in words)
    ctx[names.lemmas] = tuple(word.lemma for word in words)
    ctx[names.pos] = tuple(word.pos for word in words)
    ctx[names.tags] = tuple(word.tag for word in words)
    ctx[names.entities] = seen.entities
    ctx[names.triples] = seen.triples
    ctx[names.question] = seen.question
    ctx[names.analysis] = seen
    ctx[names.yesno] = seen.yesno
    if seen.question is not None:
        ctx.emit(names.is_question, seen.question)
    if seen.about_agent:
        ctx.emit(names.about_agent)
    for name in seen.acted:
        ctx.emit(SIGNALS[name])
