"""When to greet, and when to bid farewell."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .names import module, parted
from .words import is_farewell, is_greeting

JUST_NOW = 60.0
"""Seconds for which a goodbye counts: who leaves after it is not bidden farewell again."""


@module.rule(
    when=interloc.users.added, writes=verbaliser.intent, weight=1.1
)  # before a farewell in the same moment
async def greet_who_comes(ctx: rs.RuleContext) -> None:
    """Somebody is there who was not."""
    name = ctx.payload(interloc.users.added).item
    ctx[verbaliser.intent] = Intent("greeting", {"name": name}, __package__)


@module.rule(when=interloc.users.removed, reads=parted, writes=verbaliser.intent)
async def bid_farewell_to_who_leaves(ctx: rs.RuleContext) -> rs.Resign | None:
    """Somebody is gone."""
    said = ctx[parted]
    if said is not None and ctx.now - said < JUST_NOW:
        return rs.Resign("goodbye has been said")
    name = ctx.payload(interloc.users.removed).item
    ctx[verbaliser.intent] = Intent("farewell", {"name": name}, __package__)
    return None


@module.rule(when=rawio.input.changed.where(is_greeting), writes=verbaliser.intent)
async def answer_hello(ctx: rs.RuleContext) -> None:
    """The user says hello."""
    ctx[verbaliser.intent] = Intent("hello", package=__package__)


@module.rule(when=rawio.input.changed.where(is_farewell), writes=(verbaliser.intent, parted))
async def answer_goodbye(ctx: rs.RuleContext) -> None:
    """The user says goodbye."""
    ctx[parted] = ctx.now
    ctx[verbaliser.intent] = Intent("goodbye", package=__package__)
