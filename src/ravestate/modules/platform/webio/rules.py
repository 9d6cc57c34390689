"""What a conversation on the page hears of its agent."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .names import module, page

SLOW = 0.3
"""Seconds that an answer may take before the page shows that it is being made."""


@module.rule(when=rawio.output.changed.max_age(None).detached(), reads=page)
async def show(ctx: rs.RuleContext) -> None:
    """Show what is said."""
    session = ctx[page]
    if session is not None:
        session.utter(ctx.payload(rawio.output.changed))


@module.rule(when=rawio.piece.max_age(None).detached(), reads=page, background=True)
async def show_piece(ctx: rs.RuleContext) -> None:
    """Show what is being said."""
    session = ctx[page]
    if session is not None:
        session.grow(ctx.payload(rawio.piece))


@module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=page, background=True)
async def end_piece(ctx: rs.RuleContext) -> None:
    """Take back what was being said if it never became an utterance."""
    session = ctx[page]
    if session is not None:
        session.fall_silent()


@module.rule(when=interloc.agent.changed.max_age(None).detached(), reads=page, background=True)
async def show_name(ctx: rs.RuleContext) -> None:
    """Show what the agent is called now."""
    session = ctx[page]
    if session is not None:
        session.notify()


@module.rule(when=rs.pressure.true.min_age(SLOW).max_age(None).detached(), reads=page, background=True)
async def show_delay(ctx: rs.RuleContext) -> None:
    """Show that an answer is due."""
    session = ctx[page]
    if session is not None:
        session.show_work()
