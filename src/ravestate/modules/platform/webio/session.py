"""A session: one conversation, with its context, its messages, and its open windows."""

from __future__ import annotations

import asyncio
import enum
import logging
import re
import secrets
import time
from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Protocol

from ravestate.errors import RavestateError
from ravestate.modules import interloc, rawio
from ravestate.modules._text import printable, without_controls
from ravestate.modules.platform.chats import people
from ravestate.modules.platform.chats.leaving import agent_left

from .camera import PageCamera
from .camera import Window as CameraWindow
from .fields import LONGEST_NAME, name_of
from .history import History
from .line import PageLine, Window
from .names import page

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

REMEMBERED = 512  # the number of message ids that a session remembers, to ignore repeated messages
GRACE = 0.3  # after the visitor's words, the page waits this many seconds before it shows that the agent is working
RECENT = 5  # `mark_heard` searches this many of the agent's newest messages
LONGEST_CAPTION = 1000  # the maximum number of characters in a caption
WORD = re.compile(r"\S+")
LINGER = 30.0  # after the microphone has gone off, the audio line stays in ``rawio.sound`` for this many seconds
FAREWELL = 5.0  # the agent may take this many seconds to say goodbye

log = logging.getLogger("ravestate.webio")


class Ending(enum.StrEnum):
    """The reason for the end of a conversation, in words for people other than the visitor."""

    BYE = "the visitor left"
    ABANDONED = "nobody was there"
    CROWDED = "others were waiting"
    OFF = "the agent has been switched off"
    LEFT = "the agent has left"
    FAILED = "the agent has failed"
    CANCELLED = "the conversation has been cut off"

    @property
    def for_visitor(self) -> str:
        """The reason in words for the visitor."""
        return "you left" if self is Ending.BYE else self.value


class Onlooker(Protocol):
    """An object that a session wakes after each change in its conversation."""

    def wake(self) -> None:
        """Note that the conversation has changed; look at the change later."""


class Session:
    """A visitor's conversation. It outlives its connections, and runs on one event loop.

    A session has no queue: it wakes each `Onlooker`, which reads all that it has not seen yet.
    """

    def __init__(self, context: Context, name: str | None = None, *, hears: bool = False, sees: bool = False) -> None:
        self.id = secrets.token_urlsafe(24)
        """The conversation's secret id. A client sends it to resume the conversation."""
        self.visitor = f"webio-{secrets.token_hex(4)}"
        """The key of the visitor in ``interloc.users``."""
        self.name = name
        self.began = _now()
        """The time at which the conversation began (milliseconds since 1970)."""
        self.context = context
        self.history = History()
        self.partial = ""
        """The text so far of a growing utterance of the agent; empty if there is none."""
        self.spoken = False
        """Whether the visitor has ever said anything."""
        self.hears = hears
        """Whether the agent can hear and speak."""
        self.line: PageLine | None = None
        """The line to the visitor's microphone and loudspeaker. None if the microphone was never on, or has been off for
        `LINGER` seconds."""
        self.sees = sees
        """Whether the agent can see."""
        self.camera: PageCamera | None = None
        """The visitor's camera; None if it is off in all browser windows."""
        self.caption = ""
        """The words so far of an utterance that the visitor is still speaking."""
        self.ended: Ending | None = None
        """Why the conversation is over; None if it is not over."""
        self.onlookers: set[Onlooker] = set()
        self._begun = False
        self._left: asyncio.Event = asyncio.Event()
        self._reason = Ending.CANCELLED
        self._heard: OrderedDict[str, None] = OrderedDict()
        self._put: deque[str] = deque()  # words in the history; `note_input` must not add them again
        # The part that the visitor heard of a growing utterance, if its speech was cut off.
        self._heard_part: str | None = None
        self._hanging_up: asyncio.TimerHandle | None = None
        self._working = False
        self._following: asyncio.Task[None] | None = None

    def __repr__(self) -> str:
        return f"conversation {self.visitor}"

    async def live(self) -> None:
        """Run the conversation until the visitor or the agent leaves, or the task is cancelled. Then clean up."""
        try:
            async with self.context as context:
                self._begun = True
                context.put(page, self)
                if self.line is not None:
                    context.put(rawio.sound, self.line)
                if self.camera is not None:
                    context.put(rawio.camera, self.camera)
                people.join(context, self.visitor, self.name)
                await self._until_left()
                people.leave(context, self.visitor)
                async with asyncio.timeout(FAREWELL):
                    await context.quiet()
        except TimeoutError:
            pass  # the farewell took too long
        except RavestateError as failure:  # the other conversations continue
            self._reason = Ending.FAILED
            log.error("a conversation ended: %s", failure)
        finally:
            if self._following is not None:
                self._following.cancel()
            self.fall_silent()
            self._hang_up()
            self._close_camera()
            self.ended = self._reason
            self.notify()

    def leave(self, reason: Ending) -> None:
        """End the conversation for good. Only the reason of the first call counts."""
        if not self.leaving:
            self._reason = reason
            self._left.set()

    async def _until_left(self) -> None:
        try:
            if await agent_left(self.context, self._left.wait()):
                self._reason = Ending.LEFT
        finally:
            self._left.set()  # from now on, the session ignores input

    @property
    def leaving(self) -> bool:
        """Whether the visitor or the agent has left. The session then ignores input, but the agent may say goodbye."""
        return self._left.is_set()

    def hear(self, id: str, text: str) -> bool:
        """Pass the visitor's words, which `heard_text` has checked, to the agent. Ignore words whose `id` came before.

        Returns:
            Whether the agent has got the words, now or before. False if the session is `leaving`.
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
        self._put.append(text)
        self.context.put(rawio.input, text)
        self.show_work(GRACE)
        self.notify()
        return True

    def note_input(self, text: str) -> None:
        """Add the words in `rawio.input` to the history, unless `hear` has already added them."""
        if text in self._put:
            while self._put.popleft() != text:
                pass  # a later input in the same instant has replaced these words
            return
        self.caption = ""
        self.spoken = True
        if (text := printable(text)).strip():
            self.history.add("user", text, _now())
            self.show_work(GRACE)
        self.notify()

    def show_caption(self, text: str) -> None:
        """Show the words so far of an utterance that the visitor is still speaking."""
        self.caption = printable(text)[:LONGEST_CAPTION]
        self.notify()

    def mark_heard(self, text: str) -> None:
        """Note the part that the visitor heard of the agent's last utterance."""
        words = text.split()
        if self.partial and self.partial.split()[: len(words)] == words:
            self._heard_part = text  # the utterance is not complete yet
            return
        for message in self.history.recent("agent", RECENT):
            ends = [word.end() for word in WORD.finditer(message.text)]
            if message.text.split()[: len(words)] == words:
                cut = len(message.text) if len(words) == len(ends) else ends[len(words) - 1] if words else 0
                if cut < len(message.text.rstrip()) or message.heard is not None:
                    self.history.mark(message, message.text[:cut])
                    self.notify()
                return

    def take_line(self, window: Window) -> None:
        """Give the line to a window. If there is no line yet, make one, and put it into ``rawio.sound``."""
        self._stay_on_line()
        if self.line is None or self.line.closed:
            self.line = PageLine(self._linger)
            if self._begun:
                self.context.put(rawio.sound, self.line)
        self.line.take(window)

    def _linger(self) -> None:
        """Keep the line for a while without a window, so that the agent hears the end of the visitor's utterance."""
        self._stay_on_line()
        self._hanging_up = asyncio.get_running_loop().call_later(LINGER, self._hang_up)

    def _stay_on_line(self) -> None:
        if self._hanging_up is not None:
            self._hanging_up.cancel()
            self._hanging_up = None

    def _hang_up(self) -> None:
        line, self.line = self.line, None
        if line is not None:
            if self._begun:
                self.context.put(rawio.sound, None)
            line.close()
        self._stay_on_line()

    def take_camera(self, window: CameraWindow) -> None:
        """Note that a window's camera is on, and put it into ``rawio.camera``. Any other window loses its camera."""
        if self.camera is not None:
            if self.camera.window is window and not self.camera.closed:
                return
            self.camera.refuse("the camera is on in another window")
            self._close_camera()
        if self.leaving:
            return
        self.camera = PageCamera(window)
        if self._begun:
            self.context.put(rawio.camera, self.camera)

    def leave_camera(self, window: CameraWindow) -> None:
        """Note that the camera is off in a window."""
        if self.camera is not None and self.camera.window is window:
            self._close_camera()

    def _close_camera(self) -> None:
        camera, self.camera = self.camera, None
        if camera is not None:
            camera.close()
            if self._begun:
                self.context.put(rawio.camera, None)

    def hush(self) -> None:
        """Ask the agent to stop speaking."""
        if self._begun:
            self.context.emit(rawio.hush)

    def notice_writing(self) -> None:
        """Tell the agent that the visitor is writing."""
        if not self.leaving:
            self.context.emit(rawio.typing)

    @property
    def agent(self) -> str:
        """The agent's own name (``interloc.agent``), as one line of 1 to 80 characters."""
        name = self.context.read(interloc.agent) if self._begun else ""
        return name_of(name[:LONGEST_NAME]) or interloc.agent.default

    def utter(self, text: str, origin: object = None) -> None:
        """Add a whole utterance of the agent to the history."""
        text = printable(text)
        self.partial = ""
        if text.strip():
            self.history.add("agent", text, _now())
            if self._heard_part is not None:
                part, self._heard_part = self._heard_part, None
                self.mark_heard(part)
        self.notify()

    def grow(self, piece: str, origin: object = None) -> None:
        """Add a piece to the agent's growing utterance."""
        self.partial += without_controls(piece)
        self.notify()

    def fall_silent(self, origin: object = None) -> None:
        """End the agent's growing utterance; its text so far becomes a message."""
        if self.partial:
            self.utter(self.partial)

    def show_work(self, grace: float = 0.0) -> None:
        """After `grace` seconds, show that the agent is working, until no rule can write an answer any longer.

        A filler such as "Let me think…" does not end this, because the rule for the answer itself is still running.
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
        """Whether the agent is working on an answer, and the page shows no part of it yet."""
        return self._working and not self.partial and self.ended is None

    @property
    def paused(self) -> bool:
        """Whether the context's clock is paused."""
        return self._begun and self.ended is None and self.context.paused

    def notify(self) -> None:
        """Wake the onlookers, because the conversation has changed."""
        for onlooker in self.onlookers:
            onlooker.wake()


def _now() -> int:
    return time.time_ns() // 1_000_000
