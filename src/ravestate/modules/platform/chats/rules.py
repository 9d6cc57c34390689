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
    rawio.carry(module, chat)

    @module.rule(when=command.max_age(None), writes=rawio.output, weight=0.1)
    async def explain(ctx: rs.RuleContext) -> None:
        """Explain the commands to the user. A rule of another module for the same command takes priority."""
        ctx[rawio.output] = ctx.payload(command).explanation
