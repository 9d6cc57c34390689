"""The rules: when documents are searched, and when their answer is said."""

from __future__ import annotations

import contextlib
from dataclasses import replace

import ravestate as rs
from ravestate.errors import DeclarationError, DeclarationErrors, PlatformError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.heap import give_back
from ravestate.modules import nlp, verbaliser

from .answering import Answer, Answerer
from .names import Settings, before, found, module
from .places import answerer_of
from .question import asks_in_short, is_vague
from .referring import Before, completed, other_wordings
from .wording import intent_of, wording_rule


@module.rule(when=rs.startup, background=True)
def load(ctx: rs.RuleContext) -> None:
    """Open the index and load the reader in the background, so that the first question does not have to wait."""
    with contextlib.suppress(PlatformError):  # the first question raises the error again
        try:
            answerer_of(ctx.settings).load()
            give_back()
        except ModelMissing as error:
            warn_once(ctx.log, error)


@module.rule(when=rs.startup)
async def choose_wording(ctx: rs.RuleContext) -> None:
    """Let the language model word the answers, if the settings say so."""
    settings: Settings = ctx.settings
    if settings.wording == "model":
        try:
            ctx.add_rule(wording_rule(settings))
        except (DeclarationError, DeclarationErrors) as error:
            raise PlatformError(
                "genqa.wording=model needs the language model of wildtalk: make the module wildtalk a part of this "
                "agent, or write --set genqa.wording=sentence"
            ) from error


REMEMBERED = 120.0
"""Seconds for which a later question may refer to this one."""


# It runs for every utterance, question or not. A rule that waited for the signal of a question would hold each
# statement for seconds, and `idle` would see no boredom meanwhile.
@module.rule(when=nlp.text.changed & nlp.question.changed, reads=before, writes=before, emits=found)
def find(ctx: rs.RuleContext) -> rs.Resign | None:
    """Search the documents."""
    settings: Settings = ctx.settings
    short = ctx.payload(nlp.question.changed) is None
    if short and not asks_in_short(ctx.payload(nlp.text.changed)):
        return rs.Resign("it is not a question")
    last = ctx[before]
    if last is not None and ctx.now - last.at > REMEMBERED:
        last = None
    heard = completed(ctx.payload(nlp.text.changed), last)
    if heard is None:
        return rs.Resign("it refers to a question that nobody has asked")
    try:
        answer = best_answer(answerer_of(settings), heard, settings)
    except ModelMissing as error:
        warn_once(ctx.log, error)
        return rs.Resign(str(error))
    if not answer.text:
        return rs.Resign(answer.reason)
    if answer.confidence < (settings.sure if short else settings.unsure):
        return rs.Resign(f"the documents have only {answer.text!r}, with a confidence of {answer.confidence:.2f}")
    ctx[before] = Before(answer.question.rstrip(" ?!."), answer.title, ctx.now)
    ctx.emit(found, answer)
    return None


def best_answer(answerer: Answerer, heard: str, settings: Settings) -> Answer:
    """Return the best answer. A yes-or-no question may be decided by another question; an answer to a vague one is not sure."""
    answer = answerer.answer(heard)
    if answer.confidence < settings.unsure and not answer.reason:
        for wording in other_wordings(answer.question):
            other = answerer.answer(wording)
            if other.confidence >= settings.sure:
                return other
    if is_vague(answer.question) and answer.confidence >= settings.sure:
        return replace(answer, confidence=(settings.sure + settings.unsure) / 2)
    return answer


@module.rule(when=found, writes=verbaliser.intent)
async def say(ctx: rs.RuleContext) -> None:
    """Say the answer and its source."""
    answer = ctx.payload(found)
    ctx[verbaliser.intent] = intent_of(answer, answer.text, ctx.settings)
