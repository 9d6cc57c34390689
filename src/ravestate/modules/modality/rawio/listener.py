"""The listener, which is the user's side of a conversation, and the rules that pass the agent's words to it."""

from __future__ import annotations

from typing import Any, Protocol

import ravestate as rs

from .names import output, piece, speaking


class Listener(Protocol):
    """The user's side of a conversation: it gets the agent's words.

    `origin` is the ``ctx.origin`` of the words: the object that came with the input that they answer, or None (see
    `RuleContext.origin`). An utterance grows while a rule produces it piece by piece. If several utterances grow at the
    same time, `origin` shows to which one a piece belongs.
    """

    def utter(self, text: str, origin: object = None) -> None:
        """Show the user a whole utterance of the agent."""
        ...

    def grow(self, piece: str, origin: object = None) -> None:
        """Show the user a piece of an utterance that is still growing."""
        ...

    def fall_silent(self, origin: object = None) -> None:
        """End the utterance that is still growing, if there is one: no rule continues it."""
        ...


def rest(text: str, pieces: str) -> str | None:
    """Return the part of an utterance that follows its pieces; None if the pieces belong to another utterance.

    Spaces at the beginning do not count. The pieces of a language model often end in a space that the utterance lacks;
    such a space does not count, either. But if the utterance has a letter or a digit in place of this space, the pieces
    belong to another utterance.

    Args:
        text: The whole utterance, from ``output``.
        pieces: The pieces so far, from ``piece``.

    Example:
        >>> rest("Once there was", "Once "), rest("Once", "Once "), rest("Hello", "Once ")
        ('there was', '', None)
    """
    text, pieces = text.lstrip(), pieces.lstrip()
    shown = pieces.rstrip()
    space, after = pieces[len(shown) :], text[len(shown) :]
    if not text.startswith(shown) or (space and after[:1].isalnum()):
        return None
    return after.removeprefix(space) if after.strip() else ""


def carry(module: rs.Module, slot: rs.Slot[Any]) -> None:
    """Declare the rules that pass ``output`` and ``piece`` to the `Listener` in a slot of the module."""

    @module.rule(when=output.changed.max_age(None).detached(), reads=slot)
    async def show(ctx: rs.RuleContext) -> None:
        """Show each utterance of the agent to the user."""
        if listener := ctx[slot]:
            listener.utter(ctx.payload(output.changed), ctx.origin)

    @module.rule(when=piece.max_age(None).detached(), reads=slot, background=True)
    async def show_piece(ctx: rs.RuleContext) -> None:
        """Show each piece of a growing utterance to the user."""
        if listener := ctx[slot]:
            listener.grow(ctx.payload(piece), ctx.origin)

    @module.rule(when=speaking.false.max_age(None).detached(), reads=slot, background=True)
    async def end_piece(ctx: rs.RuleContext) -> None:
        """End the utterance that is still growing, if there is one, when ``speaking`` becomes false."""
        if listener := ctx[slot]:
            listener.fall_silent(ctx.origin)

    # The condition does not ask for `speaking`. If it did, an error would wait for a later
    # utterance, and end that one.
    @module.rule(
        when=rs.error.max_age(None).detached(), reads=speaking, writes=speaking, detached=True, background=True
    )
    async def end_failed(ctx: rs.RuleContext) -> rs.Resign | None:
        """End a growing utterance after the rule that produced it has failed."""
        failed = ctx.policy.rules.get(ctx.payload(rs.error).rule)
        if failed is None or speaking not in failed.writes or not ctx[speaking]:
            return rs.Resign("the rule that failed left no utterance unfinished")
        ctx[speaking] = False
        return None
