"""A chat: the conversation of an agent with the people in one chat of a messenger."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import zlib
from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ravestate.errors import PlatformError, RavestateError
from ravestate.modules import interloc, rawio
from ravestate.modules._text import printable, without_controls

from . import people
from .commands import COMMANDS, FORGOTTEN, NOT_FORGOTTEN, UNCLEAR, UNHEARD, UNSEEN, Command, explanation
from .leaving import agent_left
from .messages import DeliveryError, Outgoing, Person
from .sender import back_off
from .splitting import split
from .store import Answer, Entry
from .voice import words_in

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

    from .room import Room

GRACE = 0.05
"""The seconds for which an answer waits for the end of the agent's work, so that one transaction covers both."""

TURN = 1.0
"""The seconds for which a message waits for the answer to the message before it. Slow answers may be interrupted."""

SLOW = 0.5
"""The seconds of work after which the chat shows that the agent is writing."""

SHOWN = 4.0
"""The seconds for which a chat shows that the agent is writing. Messengers show it for five."""

GROWTH = 1.0
"""The minimum number of seconds between two views of a growing answer. Messengers allow about one a second."""

FAREWELL = 10.0
"""The seconds that the agent has for a greeting and for a farewell."""

FETCHES = 4
"""The number of attempts to fetch a file."""


class Chat:
    """A conversation, put to rest after a silence and taken up again with the next message.

    The chat hears its messages in order. A message is done once no rule can write an answer to it any more. Its answers
    and its end are kept in one transaction, so that it is neither lost nor answered twice if the process dies.
    """

    def __init__(self, room: Room, id: str) -> None:
        self.id = id
        """The chat's id on the messenger."""
        self.context: Context | None = None
        """The context of the conversation; None while the chat rests."""
        self.last_active = 0.0
        """The time of the last message, on the clock of the event loop."""
        self._room = room
        self._waiting: deque[Entry] = deque()  # messages that the agent has not heard
        self._hearing: Entry | None = None  # the message that the agent is about to hear
        self._open: list[Entry] = []  # messages that the agent has heard, and may still answer
        self._said: list[Answer] = []  # answers that are not in the store yet
        self._repeated: Counter[str] = Counter()  # answers that the store has from before a crash
        self._partial = ""
        self._grown = asyncio.Event()
        self._mute = False
        self._leave = False
        self._gone = False
        self._news = asyncio.Event()
        self._following: asyncio.Task[None] | None = None
        self._flush: asyncio.TimerHandle | None = None

    def __repr__(self) -> str:
        return f"chat {self.id}"

    @property
    def busy(self) -> bool:
        """Whether there are messages that are not done."""
        return bool(self._waiting or self._hearing or self._open)

    # ------------------------------------------------------------------------------------ from the messenger

    def take(self, entry: Entry) -> None:
        """Take a message that the store has kept."""
        message = entry.message
        if message.kind == "left":
            self.close()
            return
        if message.kind == "edit" and (n := self._unheard(message.id)) is not None:
            self._waiting[n] = self._room.store.change(self._waiting[n], message.text)
            self._room.store.commit((), [entry])
            return
        self._waiting.append(entry)
        self._news.set()

    def _unheard(self, id: str) -> int | None:
        return next((n for n, entry in enumerate(self._waiting) if entry.message.id == id), None)

    def rest(self) -> None:
        """Put the chat to rest; a message that comes later takes it up again."""
        self._leave = True
        self._news.set()

    def close(self) -> None:
        """End the chat for good: the agent is no longer in it."""
        self._gone = True
        self._mute = True
        self._waiting.clear()
        self.rest()

    async def live(self) -> None:
        """Hold conversations until no messages are left."""
        while self._waiting and not self._room.closing:
            self._leave = False
            try:
                await self._converse()
            except RavestateError as error:  # the other chats continue
                self._room.log.error("%r ended: %s", self, error)
                self._end(finished=True)
            finally:
                self._end(finished=False)
                self.context = None
        if self._gone:
            self._room.store.forget(self.id)

    async def _converse(self) -> None:
        first = self._waiting[0]
        # If the process dies, the next one hears the same message with the same random choices.
        context = self._room.agent.context(seed=zlib.crc32(f"{self.id} {first.message.key}".encode()))
        async with context:
            self.context = context
            context.put(self._room.slot, self)
            try:
                if not await agent_left(context, self._hear_all()):
                    await self._answered(FAREWELL)
                self._end(finished=not self._room.closing)
            finally:
                self._end(finished=False)
                self._mute = True  # a chat is put to rest in silence

    async def _answered(self, seconds: float) -> None:
        """Wait until the agent has answered all that it has heard, or until `seconds` have passed."""
        if self._following is not None:
            await asyncio.wait((self._following,), timeout=seconds)

    def _end(self, finished: bool) -> None:
        """End a conversation. With `finished`, all its messages are done; the others are heard again at the next start."""
        if self._following is not None:
            self._following.cancel()
            self._following = None
        if finished and self._hearing is not None:
            self._open.append(self._hearing)
        self._commit(self._open if finished else ())
        self._hearing = None
        self._open = []
        self._repeated.clear()

    async def _hear_all(self) -> None:
        while not self._leave:
            if self._waiting:
                self.last_active = asyncio.get_running_loop().time()
                self._hearing = self._waiting.popleft()
                await self._hear(self._hearing)
                self._open.append(self._hearing)
                self._hearing = None
                self._follow()
                await self._answered(TURN)
                continue
            self._news.clear()
            try:
                async with asyncio.timeout(self._room.rest):
                    await self._news.wait()
            except TimeoutError:
                if not self._open:
                    return

    async def _hear(self, entry: Entry) -> None:
        context, message = self.context, entry.message
        assert context is not None  # the conversation runs
        for answer in self._room.store.recorded(entry.n):
            self._repeated[answer.text] += 1
        new = await self._meet(context, message.person)
        kind = message.kind
        if kind == "command" and message.text in COMMANDS:
            await self._obey(context, entry, new)
        elif kind == "reaction":
            context.emit(rawio.reaction, message.text)
        elif kind in ("picture", "voice"):
            await self._open_file(context, entry)
        elif kind == "edit" and self._room.store.answer_to(entry) is None:
            pass  # the conversation has moved on
        elif message.text.strip():
            context.put(rawio.input, printable(message.text))

    async def _meet(self, context: Context, person: Person) -> bool:
        """Add a person who is not present to the users; return whether the agent has never met them in this chat."""
        name = self._room.name
        if people.present(context, name, person):
            return False
        new = not self._room.store.knows(self.id, person)
        self._mute = not new  # a person who was here before is not greeted again
        await people.welcome(context, name, person, self._room.log)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(FAREWELL):
                await context.quiet()
        await people.recalled(context)
        self._mute = self._gone
        self._room.called.add(context.read(interloc.agent))
        return new

    async def _obey(self, context: Context, entry: Entry, new: bool) -> None:
        message, name = entry.message, self._room.name
        if message.text == "forget":
            try:
                await people.forget(context, name, message.person)
                reply = FORGOTTEN
            except RavestateError as error:
                self._room.log.error("a person was not forgotten: %s", error)
                reply = NOT_FORGOTTEN
            self.utter(reply)
            self._mute = True
            self._leave_soon(context, message.person, forgotten=reply == FORGOTTEN)
        elif message.text == "stop":
            self._leave_soon(context, message.person)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(FAREWELL):
                    await context.quiet()
        elif not (message.text == "start" and new and self._spoken):
            command = Command(message.text, explanation(context.read(interloc.agent)))
            context.emit(self._room.command, command)

    def _leave_soon(self, context: Context, person: Person, forgotten: bool = False) -> None:
        people.leave(context, people.key(self._room.name, person))
        if not context.read(interloc.users) or forgotten:
            self._leave = True

    @property
    def _spoken(self) -> bool:
        """Whether the agent has greeted the person whose message it is about to hear."""
        return bool(self._said or (self._hearing and self._room.store.recorded(self._hearing.n)))

    async def _open_file(self, context: Context, entry: Entry) -> None:
        """Show the agent a picture, or let it hear a voice note."""
        message = entry.message
        try:
            data = await self._fetch(message.file)
        except DeliveryError as error:
            self._room.log.warning("a file was not fetched: %s", error)
            self.utter(UNSEEN)
            return
        if message.kind == "picture":
            context.put(rawio.picture, data)
            text = message.text
        else:
            try:
                text = await words_in(data)
            except PlatformError as error:
                self._room.log.warning("a voice note was not understood: %s", error)
                self.utter(UNHEARD)
                return
            if not text.strip():
                self.utter(UNCLEAR)
        if text.strip():
            context.put(rawio.input, printable(text))

    async def _fetch(self, file: str) -> bytes:
        for attempt in range(FETCHES):
            try:
                return await self._room.carrier.fetch(file)
            except DeliveryError as error:
                if error.final or attempt == FETCHES - 1:
                    raise
                await asyncio.sleep(error.wait or back_off(attempt))
        raise AssertionError("the last attempt raises")

    # ------------------------------------------------------------------------------------ from the agent

    def utter(self, text: str) -> None:
        """Take a whole utterance of the agent."""
        self._partial = ""
        text = printable(text).strip()
        if not text or self._mute:
            return
        cause = self._cause()
        emoji = self._room.carrier.can_react(text) and cause is not None
        for n, part in enumerate([text] if emoji else split(text, self._room.carrier.longest)):
            if self._repeated[part] > 0:  # the process died after this answer
                self._repeated[part] -= 1
            else:
                self._say(Outgoing(key="", chat=self.id, text=part), cause, emoji=emoji, first=n == 0)

    def send_picture(self, data: bytes, caption: str = "") -> None:
        """Send a picture (the bytes of a JPEG or PNG file) to the chat."""
        if not self._mute:
            self._say(Outgoing(key="", chat=self.id, kind="picture", text=caption, data=data), self._cause())

    def _cause(self) -> Entry | None:
        """Return the message that the agent now answers: the oldest without an answer (L12)."""
        answered = {answer.cause for answer in self._said}
        waiting = (entry for entry in self._open if entry.n not in answered)
        return next(waiting, None) or self._hearing or (self._open[-1] if self._open else None)

    def _say(self, message: Outgoing, cause: Entry | None, *, emoji: bool = False, first: bool = True) -> None:
        if cause is not None:
            heard = cause.message
            if emoji:
                message = replace(message, kind="reaction", to=heard.id)
            elif message.kind == "text" and heard.kind == "edit" and first:
                if answer := self._room.store.answer_to(cause):
                    message = replace(message, kind="edit", to=answer)
            elif heard.kind == "voice" and message.kind == "text":
                message = replace(message, kind="voice", to=heard.id)
            elif first and heard.kind != "reaction" and (heard.group or len(self._open) > 1):
                message = replace(message, to=heard.id)
        key = secrets.token_hex(12)
        self._said.append(Answer(replace(message, key=key), None if cause is None else cause.n))
        if self._flush is None:
            self._flush = asyncio.get_running_loop().call_later(GRACE if self._following else 0.0, self._commit)

    def grow(self, piece: str) -> None:
        """Take a piece of an utterance that is still growing. It becomes a message once it is whole."""
        self._partial += without_controls(piece)
        self._grown.set()

    def fall_silent(self) -> None:
        """End a growing utterance that no rule has written as a whole."""
        if self._partial:
            self.utter(self._partial)

    # ------------------------------------------------------------------------------------ to the store

    def _follow(self) -> None:
        """Wait in a task until the agent has answered all that it has heard."""
        if self._following is None:
            self._following = asyncio.create_task(self._until_answered())

    async def _until_answered(self) -> None:
        assert self.context is not None  # the conversation runs
        work = asyncio.create_task(self._show_work())
        try:
            while self._open:
                heard = tuple(self._open)
                await self.context.quiet(rawio.output)
                self._commit(heard)
        except RavestateError:
            return  # the conversation has failed
        finally:
            work.cancel()
        self._following = None

    async def _show_work(self) -> None:
        await asyncio.sleep(SLOW)
        while True:
            self._grown.clear()
            if not self._mute and self._room.sender.pace.spare():  # messages take priority
                try:
                    await self._room.carrier.show_work(self.id, printable(self._partial).strip())
                except DeliveryError as error:  # a failure to show it does no harm
                    await asyncio.sleep(error.wait)
            await asyncio.sleep(GROWTH)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SHOWN - GROWTH):
                    await self._grown.wait()

    def _commit(self, done: Sequence[Entry] = ()) -> None:
        """Keep the answers in the store, and that some messages are done."""
        if self._flush is not None:
            self._flush.cancel()
            self._flush = None
        if self._gone:
            return
        if self._said or done:
            self._room.store.commit(self._said, done)
        if self._said:
            self._room.sender.wake(self.id)
        self._said = []
        self._open = [entry for entry in self._open if entry not in done]
        if not self._open and self._hearing is None:
            self._repeated.clear()
