"""Awkward pauses: the user says nothing, or has to wait."""

from __future__ import annotations

import ravestate as rs

__all__ = ["Settings", "bored", "impatient", "module"]


class Settings(rs.Settings):
    """When a pause is awkward."""

    bored_after: float = 5.0
    """Seconds without activity after which the agent is bored."""
    impatient_after: float = 1.0
    """Seconds for which a ready rule is kept waiting before the agent is impatient."""


module = rs.Module("idle", settings=Settings)

bored = module.signal("bored")
"""Nothing has happened for ``bored_after`` seconds; once for each stretch of quiet (from startup on), and an answer to
it begins a new one."""

impatient = module.signal("impatient")
"""Something has been due for ``impatient_after`` seconds: an answer takes its time."""


@module.rule(
    when=rs.activity.false.min_age(Settings.bored_after).max_age(None),
    emits=bored,
    detached=True,
    background=True,
)
async def notice_silence(ctx: rs.RuleContext) -> None:
    """Nothing holds a spike or runs: say so."""
    ctx.emit(bored)


@module.rule(
    when=rs.startup.detached(),
    reads=rs.activity,
    emits=bored,
    until=rs.activity.true,
    detached=True,
    background=True,
)
async def notice_first_silence(ctx: rs.RuleContext) -> None:
    """Nothing has happened since the start, so that no activity could end: say so."""
    if not ctx[rs.activity]:
        await ctx.sleep(ctx.settings.bored_after)
        ctx.emit(bored)


@module.rule(
    when=rs.pressure.true.min_age(Settings.impatient_after).max_age(None),
    emits=impatient,
    detached=True,
    background=True,
)
async def notice_delay(ctx: rs.RuleContext) -> None:
    """A ready rule is kept waiting: say so."""
    ctx.emit(impatient)
