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
    from .store import Entry

SLOW = 0.5
"""After the agent has worked for this many seconds, the chat shows that the agent is writing."""

SHOWN = 4.0
"""The sign that the agent is writing is repeated after this many seconds. Messengers show it for five seconds."""

GROWTH = 1.0
"""The minimum time between two updates of a growing answer (seconds). Messengers allow about one update a second."""


class Draft:
    """The growing answers of the agent in a chat. The chat shows the answer that grew last."""

    def __init__(self, chat: str) -> None:
        self._texts: dict[Entry | None, str] = {}  # for each message: the words so far of its growing answer
        self._cut: set[Entry | None] = set()  # the messages whose growing answers have been cut off
        self._last: Entry | None = None  # the message whose answer grew last
        self._chat = chat
        self._grown = asyncio.Event()

    def grow(self, piece: str, cause: Entry | None) -> None:
        """Add a piece to the growing answer to a message. If `cause` is None, the words answer no message."""
        if cause in self._cut:
            self.take(cause)  # the words before the cut belong to another answer
        self._texts[cause] = self._texts.get(cause, "") + without_controls(piece)
        self._last = cause
        self._grown.set()

    def take(self, cause: Entry | None) -> str:
        """Remove the growing answer to a message, and return its words."""
        self._cut.discard(cause)
        return self._texts.pop(cause, "")

    def cut_off(self) -> None:
        """Note that no growing answer gets more pieces: the next piece begins a new answer.

        The words stay until the next `cut_off`, because `Chat.fall_silent`, which sends them, may be called later.
        """
        for cause in self._cut:
            self._texts.pop(cause, None)
        self._cut = set(self._texts)

    async def show(self, room: Room, silent: Callable[[], bool]) -> None:
        """Show that the agent is writing, with the words so far, until cancelled. Pause while `silent` returns True."""
        try:
            await asyncio.sleep(SLOW)
            while True:
                self._grown.clear()
                if not silent() and room.sender.pace.spare():  # messages take priority
                    try:
                        await room.sender.show_work(self._chat, printable(self._texts.get(self._last, "")).strip())
                    except DeliveryError as error:  # it does no harm if the chat shows no draft
                        await asyncio.sleep(error.wait)
                await asyncio.sleep(GROWTH)
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(SHOWN - GROWTH):
                        await self._grown.wait()
        finally:
            self._last = None  # an answer that was cut off must not show later
