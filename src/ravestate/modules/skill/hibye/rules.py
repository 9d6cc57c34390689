"""The rules of hibye. The agent greets users, and says goodbye to them."""

from __future__ import annotations

import asyncio
from functools import cache
from importlib.resources import files

import ravestate as rs
from ravestate.language.acts import heard, only
from ravestate.language.examples import read_examples
from ravestate.language.matcher import Matcher, bundled_matcher
from ravestate.modules import idle, interloc, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .names import answered, goodbye, greeted, hello, module, parted

JUST_NOW = 60.0
"""For this many seconds after its greeting, the agent says no second hello to a user who greets. For the same time after
its goodbye, it says no second goodbye to a user who leaves."""
GENERAL = 0.15
"""The weight of the rules that answer the user's hello or goodbye. Almost every other rule that can answer outranks
these rules."""


@module.rule(
    when=interloc.users.added | interloc.recognised,
    reads=(answered, parted, interloc.users),
    writes=(verbaliser.intent, greeted),
    weight=1.1,  # if a user comes and another one leaves at the same time, the greeting wins
)
async def greet_arrivals(ctx: rs.RuleContext) -> rs.Resign | None:
    """Greet a user who comes, or whom a platform has recognised, unless the agent has just answered their hello."""
    user = ctx.payload(interloc.users.added) or ctx.payload(interloc.recognised)
    if _has_just_answered(ctx, user.key):
        return rs.Resign("the agent has just answered the user's hello")
    ctx[greeted] = ctx.now
    intent = "recognised" if isinstance(user.item, interloc.Recognised) else "greeting"
    ctx[verbaliser.intent] = Intent(intent, {"name": user.item}, __package__)
    return None


def _has_just_answered(ctx: rs.RuleContext, key: str) -> bool:
    """Return whether the agent has just answered the hello of the user `key`, who may not have been in `users` then.

    A user whose voice is heard first is added later, for example when the camera sees them.
    """
    if (last := ctx[answered]) is None or set(ctx[interloc.users]) != {key}:
        return False
    time, present = last
    left = ctx[parted]
    return ctx.now - time < JUST_NOW and (left is None or left < time) and present <= {key}


@module.rule(when=interloc.users.removed, reads=parted, writes=(verbaliser.intent, answered))
async def bid_farewell(ctx: rs.RuleContext) -> rs.Resign | None:
    """Say goodbye to a user who leaves."""
    said = ctx[parted]
    if said is not None and ctx.now - said < JUST_NOW:
        return rs.Resign("the agent has just said goodbye")
    ctx[answered] = None
    name = ctx.payload(interloc.users.removed).item
    ctx[verbaliser.intent] = Intent("farewell", {"name": name}, __package__)
    return None


@module.rule(when=rawio.input.changed, emits=(hello, goodbye))
async def listen(ctx: rs.RuleContext) -> None:
    """Notice a greeting or a goodbye.

    The sentence model, which compares meanings, may take a few milliseconds, so it runs in a thread.
    """
    act = await asyncio.to_thread(_only_act, ctx.payload(rawio.input.changed))
    if act:
        ctx.emit(hello if act == "greeting" else goodbye)


@module.rule(
    when=hello,
    reads=(greeted, interloc.users),
    writes=(verbaliser.intent, greeted, answered),
    weight=GENERAL,
)
async def answer_hello(ctx: rs.RuleContext) -> None:
    """Answer a greeting. If the agent has just greeted the user, do not say hello again."""
    said = ctx[greeted]
    returned = said is not None and ctx.now - said < JUST_NOW
    ctx[greeted] = ctx.now
    ctx[answered] = ctx.now, frozenset(ctx[interloc.users])
    ctx[verbaliser.intent] = Intent("returned" if returned else "hello", package=__package__)


@module.rule(when=goodbye, reads=(rawio.input, idle.sorrow), writes=(verbaliser.intent, parted), weight=0.9 * GENERAL)
async def answer_goodbye(ctx: rs.RuleContext) -> None:
    """Answer a goodbye. Wish a good night to a user who goes to bed, and say nothing cheerful to a sad user."""
    ctx[parted] = ctx.now
    night = await asyncio.to_thread(_goes_to_bed, ctx[rawio.input])
    intent = "goodnight" if night else "solace" if ctx[idle.sorrow] else "goodbye"
    ctx[verbaliser.intent] = Intent(intent, package=__package__)


def _only_act(text: str) -> str:
    said = heard(text)
    return next((act for act in ("greeting", "farewell") if only(act, said)), "")


@cache
def _partings() -> Matcher:
    found = read_examples(files(__package__ or "") / "partings.yaml")
    return Matcher(found.classes, found.none)


def _goes_to_bed(text: str) -> bool:
    if bundled_matcher("acts").loaded:  # if the sentence model is not loaded, only words that equal an example count
        _partings().load()
    return any(_partings().match_all(heard(text)))
