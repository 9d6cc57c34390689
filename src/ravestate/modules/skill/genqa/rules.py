"""When documents are asked, and what is said of what they say."""

from __future__ import annotations

import contextlib

import ravestate as rs
from ravestate.errors import DeclarationError, DeclarationErrors, PlatformError
from ravestate.modules import nlp, rawio, verbaliser
from ravestate.modules._room import give_back

from . import Settings, found, module
from .places import answerer_of
from .wording import intent_of, wording_rule


@module.rule(when=rs.startup, background=True)
def load(ctx: rs.RuleContext) -> None:
    """Open the index and load the reader while the agent is up already, so that the first question need not wait."""
    with contextlib.suppress(PlatformError):  # which is told when it is needed
        answerer_of(ctx.settings).load()
        give_back()


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


# Of every utterance, question or not: a rule that waited for the signal of a question would hold each statement for
# seconds, and nobody would be bored meanwhile.
@module.rule(when=rawio.input.changed & nlp.question.changed, emits=found)
def find(ctx: rs.RuleContext) -> rs.Resign | None:
    """Ask the documents."""
    if ctx.payload(nlp.question.changed) is None:
        return rs.Resign("it is no question")
    settings: Settings = ctx.settings
    answer = answerer_of(settings).answer(ctx.payload(rawio.input.changed))
    if not answer.text:
        return rs.Resign(answer.reason)
    if answer.confidence < settings.unsure:
        return rs.Resign(
            f"the documents have only {answer.text!r}, with a confidence of {answer.confidence:.2f}"
        )
    ctx.emit(found, answer)
    return None


@module.rule(when=found, writes=verbaliser.intent)
async def say(ctx: rs.RuleContext) -> None:
    """Say what the documents say, and where it is from."""
    answer = ctx.payload(found)
    ctx[verbaliser.intent] = intent_of(answer, answer.text, ctx.settings)
