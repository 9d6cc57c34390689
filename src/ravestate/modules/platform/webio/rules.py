"""The rules that show the agent's words and work on the page."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .names import module, page

SLOW = 0.3  # the seconds of waiting after which the page shows that the agent is working


@module.rule(when=rawio.output.changed.max_age(None).detached(), reads=page)
async def show(ctx: rs.RuleContext) -> None:
    """Show each utterance of the agent on the page."""
    if session := ctx[page]:
        session.utter(ctx.payload(rawio.output.changed))


@module.rule(when=rawio.piece.max_age(None).detached(), reads=page, background=True)
async def show_piece(ctx: rs.RuleContext) -> None:
    """Show each piece of a growing utterance on the page."""
    if session := ctx[page]:
        session.grow(ctx.payload(rawio.piece))


@module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=page, background=True)
async def end_piece(ctx: rs.RuleContext) -> None:
    """End a growing utterance that no rule has written as a whole."""
    if session := ctx[page]:
        session.fall_silent()


@module.rule(when=rawio.input.changed.max_age(None).detached(), reads=page)
async def show_input(ctx: rs.RuleContext) -> None:
    """Show the visitor's words on the page if they came in another way, such as by voice."""
    if session := ctx[page]:
        session.note_input(ctx.payload(rawio.input.changed))


@module.rule(when=rawio.hearing.max_age(None).detached(), reads=page, background=True)
async def caption(ctx: rs.RuleContext) -> None:
    """Show the words of an utterance that the visitor is still speaking."""
    if session := ctx[page]:
        session.show_caption(ctx.payload(rawio.hearing))


@module.rule(when=rawio.hush.max_age(None).detached(), reads=page, background=True)
async def hush(ctx: rs.RuleContext) -> None:
    """Silence the visitor's loudspeaker. The rule that speaks has heard of it already."""
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
