"""The rules: when a pause is filled."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

from .names import filled, module

ENOUGH = 5.0
"""Seconds until another filler may follow."""


@module.rule(
    when=rawio.input.changed.detached(),
    emits=idle.impatient,
    until=rawio.input.changed
    | rawio.output.changed
    | rawio.speaking.true
    | rs.activity.false
    | idle.impatient,
    detached=True,
    background=True,
)
async def notice_no_answer(ctx: rs.RuleContext) -> None:
    """Raise `impatient` when an answer runs long without output. `idle` sees only rules that are kept waiting."""
    await ctx.sleep(ctx.settings.unanswered_after)
    ctx.emit(idle.impatient)


def _silent(speaking: bool) -> bool:
    return not speaking


@module.rule(
    when=idle.impatient.max_age(0.0) & rawio.speaking.holds(_silent),  # later the answer may be there
    reads=filled,
    writes=(verbaliser.intent, filled),
)
async def fill_the_pause(ctx: rs.RuleContext) -> rs.Resign | None:
    """Say a filler while nothing else is said."""
    last = ctx[filled]
    if last is not None and ctx.now - last < ENOUGH:
        return rs.Resign(f"a pause was filled {ctx.now - last:.1f} s ago")
    ctx[filled] = ctx.now
    ctx[verbaliser.intent] = Intent("filler", package=__package__)
    return None
