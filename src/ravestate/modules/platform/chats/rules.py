"""The rules that carry the agent's words to a chat. A platform declares them on its own module."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import rawio

from .chat import Chat
from .commands import Command


def connect(module: rs.Module, chat: rs.Slot[Chat | None], command: rs.Signal[Command]) -> None:
    """Declare the rules of a platform with many chats.

    Args:
        module: The platform's module. `Room` finds the slot and the signal there, by the names ``chat`` and ``command``.
        chat: The slot ``chat``, with the chat of the context.
        command: The signal ``command``, an input, for the commands ``/start`` and ``/help``.
    """

    @module.rule(when=rawio.output.changed.max_age(None).detached(), reads=chat)
    async def show(ctx: rs.RuleContext) -> None:
        """Send each utterance of the agent to the chat."""
        if here := ctx[chat]:
            here.utter(ctx.payload(rawio.output.changed), ctx.origin)

    @module.rule(when=rawio.piece.max_age(None).detached(), reads=chat, background=True)
    async def show_piece(ctx: rs.RuleContext) -> None:
        """Add each piece to a growing utterance."""
        if here := ctx[chat]:
            here.grow(ctx.payload(rawio.piece), ctx.origin)

    @module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=chat, background=True)
    async def end_piece(ctx: rs.RuleContext) -> None:
        """End a growing utterance that no rule has written as a whole."""
        if here := ctx[chat]:
            here.fall_silent(ctx.origin)

    @module.rule(when=command.max_age(None), writes=rawio.output, weight=0.1)
    async def explain(ctx: rs.RuleContext) -> None:
        """Explain the commands to the user. A rule of another module for the same command takes priority."""
        ctx[rawio.output] = ctx.payload(command).explanation
