"""Fills a pause: "Let me think..." when an answer takes its time."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

__all__ = ["Settings", "filled", "module"]

ENOUGH = 5.0
"""Seconds for which one filler is enough."""


class Settings(rs.Settings):
    """When an answer takes long."""

    unanswered_after: Annotated[float, Field(gt=0)] = 2.0
    """Seconds from the user's words until an answer that is being made, and of which nothing is heard yet, takes long."""


module = rs.Module("fillers", requires=[rawio, idle, verbaliser], settings=Settings)

filled: rs.Slot[float | None] = module.slot("filled", None)
"""When a pause was filled last, in seconds since the context began."""


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
    """Nobody is kept waiting, which `idle` would notice, but whoever answers has not said a word: say so."""
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
    """An answer takes its time, and nothing is being said."""
    last = ctx[filled]
    if last is not None and ctx.now - last < ENOUGH:
        return rs.Resign(f"a pause was filled {ctx.now - last:.1f} s ago")
    ctx[filled] = ctx.now
    ctx[verbaliser.intent] = Intent("filler", package=__package__)
    return None
