"""The rules that show on the page what is said, what the agent is called, and that the agent is working."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .names import module, page

SLOW = 0.3  # once a rule has waited for others for this many seconds, the page shows that the agent is working

rawio.carry(module, page)


@module.rule(when=rawio.input.changed.max_age(None).detached(), reads=page)
async def show_input(ctx: rs.RuleContext) -> None:
    """Show the visitor's words on the page, unless they were typed there."""
    if session := ctx[page]:
        session.note_input(ctx.payload(rawio.input.changed))


@module.rule(when=rawio.hearing.max_age(None).detached(), reads=page, background=True)
async def caption(ctx: rs.RuleContext) -> None:
    """Show the words of an utterance that the visitor is still speaking."""
    if session := ctx[page]:
        session.show_caption(ctx.payload(rawio.hearing))


@module.rule(when=rawio.hush.max_age(None).detached(), reads=page, background=True)
async def hush(ctx: rs.RuleContext) -> None:
    """Silence the visitor's loudspeaker. `rawio.hush` also interrupts the rule that speaks."""
    if (session := ctx[page]) and session.line is not None:
        session.line.stop()


@module.rule(when=rawio.heard.changed.max_age(None).detached(), reads=page, background=True)
async def mark_heard(ctx: rs.RuleContext) -> None:
    """Mark the part of the agent's last utterance that the visitor heard."""
    if session := ctx[page]:
        session.mark_heard(ctx.payload(rawio.heard.changed))


@module.rule(when=interloc.agent.changed.max_age(None).detached(), reads=page, background=True)
async def show_name(ctx: rs.RuleContext) -> None:
    """Show the agent's new name on the page."""
    if session := ctx[page]:
        session.notify()


@module.rule(when=rs.pressure.true.min_age(SLOW).max_age(None).detached(), reads=page, background=True)
async def show_delay(ctx: rs.RuleContext) -> None:
    """Show on the page that the agent is working."""
    if session := ctx[page]:
        session.show_work()
