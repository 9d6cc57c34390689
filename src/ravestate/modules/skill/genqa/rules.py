"""The rules that search the documents and say their answer."""

from __future__ import annotations

import contextlib

import ravestate as rs
from ravestate.errors import DeclarationError, DeclarationErrors, PlatformError
from ravestate.language.bundled import ModelMissing, warn_once
from ravestate.language.loading import wait_for_prompt
from ravestate.modules import nlp, rawio, verbaliser

from .answering import Answer, together
from .following import answer_in
from .names import Settings, found, module, thread
from .places import answerer_of
from .question import not_asked, parsed
from .thread import KEPT, REMEMBERED, Turn, overheard, refers
from .wording import intent_of, wording_rule


@module.rule(when=rs.startup, background=True)
def load(ctx: rs.RuleContext) -> None:
    """Open the index and load the reader (the model that judges passages), so that the first question need not wait."""
    wait_for_prompt()
    with contextlib.suppress(PlatformError):  # the first question raises the error again
        try:
            answerer_of(ctx.settings).load()
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
                "genqa.wording=model needs the language model of wildtalk: add the module wildtalk to this "
                "agent, or write --set genqa.wording=sentence"
            ) from error


# This rule runs for every utterance. If it waited for a signal that only questions raise, it would hold the spikes of
# each statement for seconds. During these seconds, `idle` would not see the silence.
@module.rule(when=nlp.text.changed & nlp.analysis.changed, reads=(thread, rawio.output), writes=thread, emits=found)
def find(ctx: rs.RuleContext) -> rs.Resign | None:
    """Search the documents for an answer to each question of the utterance."""
    settings: Settings = ctx.settings
    analysis = ctx.payload(nlp.analysis.changed)
    if analysis is None:
        return rs.Resign("nothing was analysed")
    turns = tuple(turn for turn in ctx[thread] if ctx.now - turn.at <= REMEMBERED)
    answers, new, reasons = list[Answer](), list[Turn](), list[str]()
    for asked in analysis.questions or (analysis,):
        heard = parsed(asked.tree, asked.entities, asked.question)
        if reason := not_asked(heard, analysis):
            reasons.append(reason)
            continue
        said, view = (
            ctx[rawio.output],
            () if reasons else turns,
        )  # in "who are you? and in Peru?", the second part does not follow an older question
        if new:
            view = tuple(new)  # "who wrote Faust, and when was he born?"
        elif said and not (view and view[-1].answer in said) and any(refers(word, heard.asked) for word in heard.asked):
            view = (*view, overheard(said, ctx.now))
        try:
            answer, turn = answer_in(answerer_of(settings), heard, view, settings, ctx.now)
        except ModelMissing as error:
            warn_once(ctx.log, error)
            return rs.Resign(str(error))
        if turn is not None:
            answers.append(answer)
            new.append(turn)
        elif answer.text:
            reasons.append(f"the documents have only {answer.text!r}, with a confidence of {answer.confidence:.2f}")
        else:
            reasons.append(answer.reason)
    if not answers:
        return rs.Resign("; ".join(reasons))
    ctx[thread] = (*turns, *new)[-KEPT:]
    ctx.emit(found, together(answers))
    return None


@module.rule(when=found, writes=verbaliser.intent)
async def say(ctx: rs.RuleContext) -> None:
    """Say the answer; name its source if it comes from a document that was not written for Ravestate."""
    answer = ctx.payload(found)
    ctx[verbaliser.intent] = intent_of(answer, answer.text, ctx.settings)
