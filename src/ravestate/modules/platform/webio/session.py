"""One conversation: a context, what was said in it, and the connections that look on."""

from __future__ import annotations

import asyncio
import enum
import logging
import secrets
import time
from collections import OrderedDict
from typing import TYPE_CHECKING, Protocol

from ravestate.errors import RavestateError
from ravestate.modules import interloc, rawio
from ravestate.modules._text import printable, without_controls

from .history import History
from .names import page
from .protocol import LONGEST_NAME, name_of

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

__all__ = ["Ending", "Onlooker", "Session"]

REMEMBERED = 512
"""Ids of the client's messages that are known, so that what is sent twice is heard once."""

GRACE = 0.3
"""Seconds that an answer may take before it is shown that it is being made."""

FAREWELL = 5.0
"""Seconds that the agent has for a farewell."""

log = logging.getLogger("ravestate.webio")


class Ending(enum.StrEnum):
    """Why a conversation is over, for whoever looks on."""

    BYE = "the visitor left"
    ABANDONED = "nobody was there"
    CROWDED = "others were waiting"
    OFF = "the agent has been switched off"
    LEFT = "the agent has left"
    FAILED = "the agent has failed"
    CANCELLED = "the conversation has been cut off"

    @property
    def for_visitor(self) -> str:
        """The same, for the visitor."""
        return "you left" if self is Ending.BYE else self.value


class Onlooker(Protocol):
    """Whoever wants to know when something in a conversation changes."""

    def wake(self) -> None:
        """Something has changed: look when you have time."""
        ...


class Session:
    """A visitor's conversation. It outlives its connections; all of it happens on one event loop.

    It holds no queue for anybody: an `Onlooker` is woken, and reads what it has not seen yet.

    Args:
        context: The visitor's own, which nobody has entered yet.
        name: What the visitor is called, if it is known.
    """

    def __init__(self, context: Context, name: str | None = None) -> None:
        self.id = secrets.token_urlsafe(24)
        """The secret by which a client takes the conversation up again."""
        self.visitor = f"webio-{secrets.token_hex(4)}"
        """The key of the visitor in ``interloc.users``."""
        self.name = name
        self.began = _now()
        """When it began (milliseconds since 1970)."""
        self.context = context
        self.history = History()
        self.partial = ""
        """What is being said, as far as it goes."""
        self.spoken = False
        """Whether the visitor has ever said anything."""
        self.ended: Ending | None = None
        """Why the conversation is over, once it is."""
        self.onlookers: set[Onlooker] = set()
        self._begun = False
        self._left: asyncio.Event = asyncio.Event()
        self._reason = Ending.CANCELLED
        self._heard: OrderedDict[str, None] = OrderedDict()
        self._working = False
        self._following: asyncio.Task[None] | None = None

    def __repr__(self) -> str:
        return f"conversation {self.visitor}"

    # ------------------------------------------------------------------------------------ life

    async def live(self) -> None:
        """Be there until the visitor or the agent leaves, or this is cancelled; then end in order."""
        try:
            async with self.context as context:
                self._begun = True
                context.put(page, self)
                context.put(interloc.users, {**context.read(interloc.users), self.visitor: self.name})
                await self._until_left()
                self._free_from_users()
                async with asyncio.timeout(FAREWELL):
                    await context.quiet()
        except TimeoutError:
            pass  # the farewell took too long
        except RavestateError as failure:  # of one conversation; the others go on
            self._reason = Ending.FAILED
            log.error("a conversation ended: %s", failure)
        finally:
            if self._following is not None:
                self._following.cancel()
            self.fall_silent()
            self.ended = self._reason
            self.notify()

    def leave(self, reason: Ending) -> None:
        """End the conversation for good."""
        if not self.leaving:
            self._reason = reason
            self._left.set()

    async def _until_left(self) -> None:
        left = asyncio.create_task(self._left.wait())
        stopped = asyncio.create_task(self.context.until_stopped())
        try:
            await asyncio.wait((left, stopped), return_when=asyncio.FIRST_COMPLETED)
            self._left.set()  # from now on nothing is heard
            if stopped.done():
                self._reason = Ending.LEFT
                stopped.result()
        finally:
            left.cancel()
            stopped.cancel()

    def _free_from_users(self) -> None:
        users = self.context.read(interloc.users)
        self.context.put(interloc.users, {key: user for key, user in users.items() if key != self.visitor})

    # ------------------------------------------------------------------------------------ the visitor

    @property
    def leaving(self) -> bool:
        """Whether the visitor or the agent has left, so that nothing more is heard; a farewell may still be said."""
        return self._left.is_set()

    def hear(self, id: str, text: str) -> bool:
        """The visitor says something. What came before under the same `id` is left aside.

        Args:
            id: What the message is called: 1 to 64 letters, digits, ``-`` or ``_``.
            text: As `heard_text` gives it.

        Returns:
            Whether it was taken, now or before; not once somebody is `leaving`.
        """
        if self.leaving:
            return False
        if id in self._heard:
            return True
        self._heard[id] = None
        if len(self._heard) > REMEMBERED:
            self._heard.popitem(last=False)
        self.spoken = True
        self.history.add("user", text, _now(), id)
        self.context.put(rawio.input, text)
        self.show_work(GRACE)
        self.notify()
        return True

    def notice_writing(self) -> None:
        """The visitor is writing something."""
        if not self.leaving:
            self.context.emit(rawio.typing)

    # ------------------------------------------------------------------------------------ the agent

    @property
    def agent(self) -> str:
        """What the agent calls itself: 1 to 80 characters on one line, whatever stands in ``interloc.agent``."""
        name = self.context.read(interloc.agent) if self._begun else ""
        return name_of(name[:LONGEST_NAME]) or interloc.agent.default

    def utter(self, text: str) -> None:
        """Add an utterance of the agent."""
        text = printable(text)
        self.partial = ""
        if text.strip():
            self.history.add("agent", text, _now())
        self.notify()

    def grow(self, piece: str) -> None:
        """Add a piece to the utterance that is still growing."""
        self.partial += without_controls(piece)
        self.notify()

    def fall_silent(self) -> None:
        """End the growing utterance; its text so far becomes a message."""
        if self.partial:
            self.utter(self.partial)

    def show_work(self, grace: float = 0.0) -> None:
        """Show that the agent is working, from `grace` seconds on, until no rule may write an answer any more.

        A filler such as "Let me think…" ends nothing: the rule that makes the answer still runs.
        """
        if self._following is None:
            self._following = asyncio.create_task(self._follow(grace))

    async def _follow(self, grace: float) -> None:
        try:
            try:
                async with asyncio.timeout(grace):
                    await self.context.quiet(rawio.output)
            except TimeoutError:
                self._working = True
                self.notify()
                await self.context.quiet(rawio.output)
        finally:
            self._following = None
            self._working = False
            self.notify()

    @property
    def typing(self) -> bool:
        """Whether the agent is working on an answer that nobody sees growing."""
        return self._working and not self.partial and self.ended is None

    @property
    def paused(self) -> bool:
        """Whether the clock of the context stands still."""
        return self._begun and self.ended is None and self.context.paused

    def notify(self) -> None:
        """Wake the onlookers: something has changed."""
        for onlooker in self.onlookers:
            onlooker.wake()


def _now() -> int:
    return time.time_ns() // 1_000_000
