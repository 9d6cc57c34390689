"""The draft of an answer, and the sign that the agent is writing."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from typing import TYPE_CHECKING

from ravestate.modules._text import printable, without_controls

from .messages import DeliveryError

if TYPE_CHECKING:
    from .room import Room

SLOW = 0.5
"""The chat shows that the agent is writing after the agent has worked for this many seconds."""

SHOWN = 4.0
"""The sign that the agent is writing is repeated after this many seconds. Messengers show it for five seconds."""

GROWTH = 1.0
"""The minimum time between two updates of a growing answer (seconds). Messengers allow about one update a second."""


class Draft:
    """A growing answer of the agent in a chat."""

    def __init__(self, chat: str) -> None:
        self.text = ""
        """The words so far."""
        self._chat = chat
        self._grown = asyncio.Event()

    def grow(self, piece: str) -> None:
        """Add a piece."""
        self.text += without_controls(piece)
        self._grown.set()

    async def show(self, room: Room, silent: Callable[[], bool]) -> None:
        """Show that the agent is writing, with the words so far, until cancelled. Pause while `silent` returns True."""
        await asyncio.sleep(SLOW)
        while True:
            self._grown.clear()
            if not silent() and room.sender.pace.spare():  # messages take priority
                try:
                    await room.sender.show_work(self._chat, printable(self.text).strip())
                except DeliveryError as error:  # it does no harm if the chat shows no draft
                    await asyncio.sleep(error.wait)
            await asyncio.sleep(GROWTH)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SHOWN - GROWTH):
                    await self._grown.wait()
