"""The rules that carry the agent's words to a chat. A platform declares them on its own module."""

from __future__ import annotations

from typing import Any, Protocol

import ravestate as rs
from ravestate.modules import rawio

from .chat import Chat
from .commands import Command


class Listener(Protocol):
    """The user's side of a conversation: it gets the agent's words."""

    def utter(self, text: str) -> None:
        """Take a whole utterance of the agent."""
        ...

    def grow(self, piece: str) -> None:
        """Take a piece of an utterance that is still growing."""
        ...

    def fall_silent(self) -> None:
        """End a growing utterance that no rule has written as a whole."""
        ...


def connect(module: rs.Module) -> tuple[rs.Slot[Chat | None], rs.Signal[Command]]:
    """Declare the slot ``chat``, the signal ``command``, and the rules of a platform with many chats; `Room` uses them.

    Returns:
        The slot with the chat of the context, and the signal for the commands ``/start`` and ``/help``.
    """
    chat: rs.Slot[Chat | None] = module.slot("chat", None)
    command: rs.Signal[Command] = module.signal("command", payload=Command, input=True)
    carry(module, chat)

    @module.rule(when=command.max_age(None), writes=rawio.output, weight=0.1)
    async def explain(ctx: rs.RuleContext) -> None:
        """Say what the user can do. A rule of another module for the same command takes priority."""
        ctx[rawio.output] = ctx.payload(command).explanation

    return chat, command


def carry(module: rs.Module, slot: rs.Slot[Any]) -> None:
    """Declare the rules that carry ``rawio.output`` and ``rawio.piece`` to the `Listener` in a slot of the module."""

    @module.rule(when=rawio.output.changed.max_age(None).detached(), reads=slot)
    async def show(ctx: rs.RuleContext) -> None:
        """Show each utterance of the agent to the user."""
        if listener := ctx[slot]:
            listener.utter(ctx.payload(rawio.output.changed))

    @module.rule(when=rawio.piece.max_age(None).detached(), reads=slot, background=True)
    async def show_piece(ctx: rs.RuleContext) -> None:
        """Show each piece of a growing utterance to the user."""
        if listener := ctx[slot]:
            listener.grow(ctx.payload(rawio.piece))

    @module.rule(when=rawio.speaking.false.max_age(None).detached(), reads=slot, background=True)
    async def end_piece(ctx: rs.RuleContext) -> None:
        """End a growing utterance that no rule has written as a whole."""
        if listener := ctx[slot]:
            listener.fall_silent()
