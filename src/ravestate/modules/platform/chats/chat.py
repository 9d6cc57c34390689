"""A chat: the conversation of an agent with the people in one chat of a messenger."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import sqlite3
import zlib
from collections import Counter, deque
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from ravestate.errors import PlatformError, RavestateError
from ravestate.modules import interloc, rawio
from ravestate.modules._text import printable

from . import people
from .attempts import back_off
from .commands import COMMANDS, FORGOTTEN, NOT_FORGOTTEN, UNCLEAR, UNHEARD, UNSEEN, Command, explanation
from .draft import Draft
from .files import fetched
from .leaving import agent_left
from .messages import DeliveryError, Outgoing, Person
from .splitting import split
from .store import Answer, Entry
from .voice import words_in

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

    from .room import Room

GRACE = 0.05
"""An answer waits at most this many seconds before it is stored. If no rule can write a further answer by then, one
transaction stores the answer and marks its message as done."""

TURN = 1.0
"""A message waits at most this many seconds for the answer to the previous message. Then it may interrupt this
answer."""

FAREWELL = 10.0
"""The maximum number of seconds to wait for a greeting, a farewell, or earlier answers."""


class Chat:
    """A conversation that rests (has no context) after a silence, and continues with the next message.

    The agent hears the messages in order. A message is done when no rule can write an answer to it any longer. The
    transaction that marks it as done also stores the answers that are not stored yet. If the process dies, the next
    process passes the unfinished messages to the agent again, but does not send a stored answer twice.
    """

    def __init__(self, room: Room, id: str) -> None:
        self.id = id
        """The chat's id on the messenger."""
        self.context: Context | None = None
        """The context of the conversation; None while the chat rests."""
        self.last_active = 0.0
        """When the agent heard the last message (time of the event loop)."""
        self._room = room
        self._waiting: deque[Entry] = deque()  # messages that the agent has not heard
        self._hearing: Entry | None = None  # the message that the agent is about to hear
        self._open: list[Entry] = []  # messages that the agent has heard, and may still answer
        self._said: list[Answer] = []  # answers that are not in the store yet
        self._repeated: Counter[object] = Counter()  # stored answers from before a crash, not to be sent again
        self._replaceable: dict[int, list[str]] = {}  # an edit's number → ids of answers to replace
        self._draft = Draft(id)
        self._state: Literal["open", "leaving", "gone"] = "open"
        self._mute = False  # whether the agent's words are dropped
        self._news = asyncio.Event()
        self._following: asyncio.Task[None] | None = None
        self._flush: asyncio.TimerHandle | None = None

    def __repr__(self) -> str:
        return f"chat {self.id}"

    @property
    def busy(self) -> bool:
        """Whether there are messages that are not done."""
        return bool(self._waiting or self._hearing or self._open)

    @property
    def leaving(self) -> bool:
        """Whether the conversation is ending or has ended."""
        return self._state != "open"

    # ------------------------------------------------------------------------------------ from the messenger

    def take(self, entry: Entry) -> None:
        """Queue a message that is already in the store."""
        self._waiting.append(entry)
        self._news.set()

    def rest(self) -> None:
        """Put the chat to rest, until the next message comes."""
        if self._state == "open":
            self._state = "leaving"
            self._news.set()

    def close(self) -> None:
        """End the chat, because the agent is no longer in it. The room cancels `live`, and deletes the messages."""
        self._state = "gone"
        self._waiting.clear()
        self._hearing, self._open, self._said = None, [], []

    async def live(self) -> None:
        """Hold one conversation after another, until no message waits."""
        while self._waiting and not self._room.closing:
            self._state = "open"
            try:
                await self._converse()
            except RavestateError as error:  # the other chats continue
                self._room.log.error("%r ended: %s", self, error)
                self._end(finished=True)
            finally:
                self._end(finished=False)
                self.context = None

    async def _converse(self) -> None:
        first = self._waiting[0]
        # The seed is fixed. So after a crash, the next process makes the same random choices for the same message.
        context = self._room.agent.context(seed=zlib.crc32(f"{self.id} {first.message.key}".encode()))
        self._repeated.update(_content(None, said) for said in self._room.store.alone(self.id))
        async with context:
            self.context, self._mute = context, False
            context.put(self._room.slot, self)
            try:
                if not (await agent_left(context, self._hear_all()) or self._mute):
                    await self._answered(FAREWELL)
                self._end(finished=not self._room.closing)
            finally:
                self._end(finished=False)
                self._mute = True  # the agent does not say goodbye when a chat rests

    async def _answered(self, seconds: float) -> bool:
        """Wait up to `seconds` until the agent has answered all that it has heard. Return whether it has."""
        if self._following is not None:
            await asyncio.wait((self._following,), timeout=seconds)
        return self._following is None

    def _end(self, finished: bool) -> None:
        """End a conversation. If `finished`, mark all its messages as done. If not, the agent hears them again later."""
        if self._following is not None:
            self._following.cancel()
            self._following = None
        heard = [*self._open, *([self._hearing] if self._hearing else [])]
        self._open = heard
        try:
            if heard and not finished and self._room.closing:
                self._room.store.unhear(heard)  # an orderly end is not a crash, so do not count it as one
            self._commit(heard if finished else ())
        except sqlite3.Error as error:  # the file still has the messages as unanswered
            self._room.log.warning("answers are not stored; the agent answers again after its next start: %s", error)
        self._hearing = None
        self._open = []
        self._repeated.clear()
        self._replaceable.clear()

    async def _hear_all(self) -> None:
        while self._state == "open":
            if self._waiting:
                self.last_active = asyncio.get_running_loop().time()
                entry = await self._next()
                await self._hear(entry)
                self._open.append(entry)
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

    async def _next(self) -> Entry:
        """Take the oldest waiting message from the queue. Return it with the text of the user's last edit."""
        entry = self._hearing = self._waiting.popleft()
        edits: list[Entry] = []
        if entry.message.kind in ("text", "edit"):
            edits = [
                each for each in self._waiting if each.message.kind == "edit" and each.message.id == entry.message.id
            ]
            self._waiting = deque(each for each in self._waiting if each not in edits)
        self._hearing = await self._room.persist(lambda: self._room.store.hear(entry, edits))
        return self._hearing

    async def _hear(self, entry: Entry) -> None:
        context, message = self.context, entry.message
        assert context is not None  # the conversation runs
        self._repeated.update(_content(entry.n, said) for said in self._room.store.recorded(entry.n))
        new = await self._meet(context, entry)
        kind = message.kind
        if kind == "command" and message.text in COMMANDS:
            await self._obey(context, entry, new)
        elif kind == "reaction":
            context.emit(rawio.reaction, message.text, origin=entry)
        elif kind in ("picture", "voice"):
            await self._open_file(context, entry)
        elif kind == "edit" and not self._can_edit(entry):
            pass  # the edited message was not the last one: ignore the edit
        elif message.text.strip():
            context.put(rawio.input, printable(message.text), origin=entry)

    def _can_edit(self, edit: Entry) -> bool:
        """Note the answers that an edit will replace. Return whether the edited message is the last one."""
        old = self._room.store.answers_to(edit)
        if old is None:
            return False
        for entry in self._open:
            if entry.message.id == edit.message.id:  # of several edits, the last one replaces the answers
                self._replaceable.pop(entry.n, None)
        replaced = [each.to for each in self._room.store.recorded(edit.n) if each.kind == "edit"]
        self._replaceable[edit.n] = [answer for answer in old if answer not in replaced]
        return True

    async def _meet(self, context: Context, entry: Entry) -> bool:
        """Add a message's sender to the present users. Return whether the sender was absent, and is new in this chat."""
        name, person = self._room.name, entry.message.person
        if people.present(context, name, person):
            return False
        new = not self._room.store.knows(self.id, person)
        # A second greeting must be mute. But a mute chat drops answers to others, too, so wait for these answers first.
        self._mute = not new and await self._answered(FAREWELL)
        await people.welcome(context, name, person, self._room.log, entry)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(FAREWELL):
                await context.quiet()
        await people.recalled(context)
        self._mute = False
        self._room.called.add(context.read(interloc.agent))
        return new

    async def _obey(self, context: Context, entry: Entry, new: bool) -> None:
        message, name = entry.message, self._room.name
        if message.text == "forget":
            await self._answered(FAREWELL)
            try:
                await people.forget(context, name, message.person)
                reply = FORGOTTEN
            except RavestateError as error:
                self._room.log.error("a person was not forgotten: %s", error)
                reply = NOT_FORGOTTEN
            self._reply(reply)
            if reply == FORGOTTEN:
                self._mute = True
                self._keep_for_later(message.person)
            self._leave_soon(context, entry, forgotten=reply == FORGOTTEN)
        elif message.text == "stop":
            self._leave_soon(context, entry)
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(FAREWELL):
                    await context.quiet()
        elif not (message.text == "start" and new and self._spoken):
            command = Command(message.text, explanation(context.read(interloc.agent)))
            context.emit(self._room.command, command, origin=entry)

    def _leave_soon(self, context: Context, entry: Entry, forgotten: bool = False) -> None:
        people.leave(context, people.key(self._room.name, entry.message.person), entry)
        if not context.read(interloc.users) or forgotten:
            self.rest()

    def _keep_for_later(self, gone: Person) -> None:
        """Put other people's messages that have no answer yet back into the queue, for the next conversation."""
        others = [entry for entry in self._open if entry.message.person.id != gone.id]
        self._open = [entry for entry in self._open if entry not in others]
        self._waiting.extendleft(reversed(others))

    @property
    def _spoken(self) -> bool:
        """Whether the agent has greeted the person whose message it is about to hear."""
        return bool(self._said or (self._hearing and self._room.store.recorded(self._hearing.n)))

    async def _open_file(self, context: Context, entry: Entry) -> None:
        """Show the agent a picture, or let it hear a voice note."""
        message = entry.message
        try:
            data = await fetched(self._room.carrier, message.file)
        except DeliveryError as error:
            self._room.log.warning("a file was not fetched: %s", error)
            self._reply(UNSEEN)
            return
        if message.kind == "picture":
            context.put(rawio.picture, data, origin=entry)
            text = message.text
        else:
            try:
                text = await words_in(data)
            except PlatformError as error:
                self._room.log.warning("a voice note was not understood: %s", error)
                self._reply(UNHEARD)
                return
            if not text.strip():
                self._reply(UNCLEAR)
        if text.strip():
            context.put(rawio.input, printable(text), origin=entry)

    # ------------------------------------------------------------------------------------ from the agent

    def utter(self, text: str, origin: object = None) -> None:
        """Send a whole utterance of the agent to the chat. `origin` is the calling rule's ``ctx.origin``."""
        cause = _cause(origin)
        self._draft.take(cause)
        self._speak(printable(text).strip(), cause)

    def _reply(self, text: str) -> None:
        """Answer the message that the agent is about to hear, without a rule."""
        self._speak(text, self._hearing)

    def _speak(self, text: str, cause: Entry | None) -> None:
        if not text or self._silent:
            return
        emoji = self._room.carrier.can_react(text) and cause is not None
        for n, part in enumerate([text] if emoji else split(text, self._longest(cause))):
            self._say(Outgoing(key="", chat=self.id, text=part), cause, emoji=emoji, first=n == 0)

    def send_picture(self, data: bytes, caption: str = "", *, origin: object = None) -> None:
        """Send a picture (the bytes of a JPEG or PNG file) to the chat.

        Args:
            data: The picture.
            caption: The words below the picture.
            origin: The rule's ``ctx.origin``, if the picture is the answer to a message.
        """
        if self._silent:
            return
        cause = _cause(origin)
        words = split(caption, self._longest(cause), first=self._room.carrier.longest_caption) or [""]
        self._say(Outgoing(key="", chat=self.id, kind="picture", text=words[0], data=data), cause)
        for part in words[1:]:
            self._say(Outgoing(key="", chat=self.id, text=part), cause, first=False)

    def _longest(self, cause: Entry | None) -> int:
        """Return the maximum number of characters in an answer to `cause`.

        The answer to a voice note is a voice note, with its words as the caption.
        """
        carrier = self._room.carrier
        return carrier.longest_caption if cause is not None and cause.message.kind == "voice" else carrier.longest

    @property
    def _silent(self) -> bool:
        return self._mute or self._state == "gone"

    def _say(self, message: Outgoing, cause: Entry | None, *, emoji: bool = False, first: bool = True) -> None:
        content = _content(None if cause is None else cause.n, message)
        if self._repeated[content] > 0:  # the process died after this answer
            self._repeated[content] -= 1
            return
        if cause is not None:
            heard = cause.message
            message = replace(message, topic=heard.topic)
            if emoji:
                message = replace(message, kind="reaction", to=heard.id)
            elif message.kind == "text" and (old := self._replaceable.get(cause.n)):
                message = replace(message, kind="edit", to=old.pop(0))
            elif heard.kind == "voice" and message.kind == "text":
                message = replace(message, kind="voice", to=heard.id)
            elif first and heard.kind != "reaction" and (heard.group or len(self._open) > 1):
                message = replace(message, to=heard.id)
        self._said.append(_answer(message, None if cause is None else cause.n))
        if self._flush is None:
            self._flush = asyncio.get_running_loop().call_later(GRACE if self._following else 0.0, self._flush_said)

    def grow(self, piece: str, origin: object = None) -> None:
        """Add a piece to the growing utterance. The utterance becomes a message when it is complete."""
        self._draft.grow(piece, _cause(origin))

    def fall_silent(self, origin: object = None) -> None:
        """Send the growing utterance as it is, if no rule has written it as a whole."""
        self.utter(self._draft.take(_cause(origin)), origin)

    # ------------------------------------------------------------------------------------ to the store

    def _follow(self) -> None:
        """Wait in a task until the agent has answered all that it has heard."""
        if self._following is None:
            self._following = asyncio.create_task(self._until_answered())

    async def _until_answered(self) -> None:
        assert self.context is not None  # the conversation runs
        work = asyncio.create_task(self._draft.show(self._room, lambda: self._silent))
        try:
            while self._open and self._state != "gone":
                heard = tuple(self._open)
                await self.context.quiet(rawio.output)
                await self._room.persist(lambda heard=heard: self._commit(heard))
        except RavestateError:
            return  # the conversation has failed
        finally:
            work.cancel()
            if not self.context.read(rawio.speaking):  # else an utterance is still growing
                self._draft.cut_off()
            if self._following is asyncio.current_task():
                self._following = None
        self._room.make_room()

    def _deletions(self, entry: Entry) -> list[Answer]:
        """Return orders to delete those earlier answers that the answers to an edit have not replaced.

        If the edit has no answer, return no orders.
        """
        left = self._replaceable.get(entry.n)
        if not left or not (any(each.cause == entry.n for each in self._said) or self._room.store.recorded(entry.n)):
            return []
        return [_answer(Outgoing(key="", chat=self.id, kind="delete", to=id), entry.n) for id in left]

    def _flush_said(self, attempt: int = 0) -> None:
        """Store the answers now, even if the agent is still working. If the file cannot be written, try again later."""
        self._flush = None
        try:
            self._commit()
        except sqlite3.Error as error:
            self._room.log.warning("answers are not stored yet: %s", error)
            self._flush = asyncio.get_running_loop().call_later(back_off(attempt), self._flush_said, attempt + 1)

    def _commit(self, done: Sequence[Entry] = ()) -> None:
        """Store the answers, and mark some of the open messages as done."""
        if self._flush is not None:
            self._flush.cancel()
            self._flush = None
        done = [entry for entry in self._open if entry in done]
        said = [*self._said, *(answer for entry in done for answer in self._deletions(entry))]
        if said or done:
            self._room.store.commit(said, done)
        if said:
            self._room.sender.wake(self.id)
        self._said = []
        for entry in done:
            self._replaceable.pop(entry.n, None)
        self._open = [entry for entry in self._open if entry not in done]
        if not self.busy:
            self._repeated.clear()


def _answer(message: Outgoing, cause: int | None) -> Answer:
    return Answer(replace(message, key=secrets.token_hex(12)), cause)


def _cause(origin: object) -> Entry | None:
    """Return the message that an output answers; None if the agent speaks on its own initiative."""
    return origin if isinstance(origin, Entry) else None


def _content(cause: int | None, message: Outgoing) -> object:
    """Return the part of a message by which the chat recognises a repetition after a crash."""
    return cause, message.text, message.data
