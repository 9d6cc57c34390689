"""The rules that carry the agent's words to a chat. A platform declares them on its own module."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import rawio

from .chat import Chat
from .commands import Command


def connect(module: rs.Module) -> tuple[rs.Slot[Chat | None], rs.Signal[Command]]:
    """Declare the slot ``chat``, the signal ``command``, and the rules of a platform with many chats, for `Room`.

    Returns:
        The slot with the chat of the context, and the signal for the commands ``/start`` and ``/help``.
    """
    chat: rs.Slot[Chat | None] = module.slot("chat", None)
    command: rs.Signal[Command] = module.signal("command", payload=Command, input=True)
    rawio.carry(module, chat)

    @module.rule(when=command.max_age(None), writes=rawio.output, weight=0.1)
    async def explain(ctx: rs.RuleContext) -> None:
        """Explain the commands to the user. A rule of another module for the same command takes priority."""
        ctx[rawio.output] = ctx.payload(command).explanation

    return chat, command
