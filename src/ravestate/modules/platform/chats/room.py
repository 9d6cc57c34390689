"""The room: all chats of an agent on one messenger."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import re
import sqlite3
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar, cast

from ravestate.errors import RavestateError
from ravestate.folders import user_folder
from ravestate.modules import interloc

from .attempts import back_off
from .chat import Chat
from .messages import Carrier, Incoming
from .sender import Sender
from .store import Entry, Store

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .settings import ChatSettings

T = TypeVar("T")
E = TypeVar("E")

LAST_WORDS = 5.0
"""When the agent ends, it has this many seconds for its last answers, and then the same time for their delivery.
The next process answers and delivers the rest."""

NAMING = 10.0
"""On entry, the room waits at most this many seconds for the rules that give the agent its name."""


class Room:
    """All chats of an agent on a messenger.

    Enter a room with ``async with Room(agent, ...) as room``. Then pass each message from the messenger to `receive`.

    On entry, the room finds out the agent's name. Then the chats get the messages that the last process left unanswered.

    Args:
        agent: The agent, which makes a context for each chat.
        name: The name of the platform's module. The module has the rules of `connect`, and the settings `ChatSettings`.
        carrier: The connection to the messenger.
        account: The agent's own id on the messenger. Each account has its own file, unless the setting `path` names one.

    Raises:
        PlatformError: The file with the messages cannot be used.
    """

    def __init__(self, agent: Agent, name: str, carrier: Carrier, account: str) -> None:
        self.agent = agent
        self.name = name
        self.carrier = carrier
        settings = cast("ChatSettings", agent.settings[name])
        self.rest = settings.rest
        self._limit = settings.chats
        self._settings = settings
        self._warned: set[str] = set()
        self.slot: Any = agent.policy.slots[f"{name}:chat"]
        self.command: Any = agent.policy.signals[f"{name}:command"]
        self.called: set[str] = set()
        """The agent's names (``interloc.agent``): its name from the start, and its names in the chats that have begun. In a
        group, a message with one of them is for the agent."""
        plain = re.sub(r"[^\w.-]", "_", account)
        self.store = Store(settings.path or user_folder("data") / "chats" / f"{name}-{plain}.sqlite")
        self.log = logging.getLogger(f"ravestate.{name}")
        self.closing = False
        """Whether the agent is being switched off."""
        self.sender = Sender(self.store, carrier, self._gone, self._moved, self.log)
        self._chats: dict[str, Chat] = {}
        self._tasks: dict[Chat, asyncio.Task[None]] = {}

    def __len__(self) -> int:
        """Return the number of chats that do not rest."""
        return len(self._tasks)

    async def __aenter__(self) -> Room:
        try:
            await self._learn_name()
        except BaseException:
            self.store.close()
            raise
        for chat in self.store.chats_to_send():
            self.sender.wake(chat)
        for entry in self.store.pending():
            self._give(entry)
        return self

    async def __aexit__(self, *_: object) -> None:
        """Put all chats to rest, and deliver their last messages."""
        self.closing = True
        try:
            for chat in self._tasks:
                chat.rest()
            tasks = list(self._tasks.values())
            if tasks:
                await asyncio.wait(tasks, timeout=LAST_WORDS)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await self.sender.close(LAST_WORDS)
        finally:
            self.store.close()

    async def _learn_name(self) -> None:
        """Note the agent's name. If rules give the agent its name, run a context without users until they have done so."""
        policy = self.agent.policy
        if not any(slot.name == interloc.agent.name for rule in policy.rules.values() for slot in rule.writes):
            self.called.add(interloc.agent.default)
            return
        context = self.agent.context()
        await context.start()
        try:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(NAMING):
                    await context.quiet(interloc.agent)
            self.called.add(context.read(interloc.agent))
        except RavestateError as error:
            self.log.warning("the agent's name is unknown until its first chat: %s", error)
        finally:
            await context.stop(grace=0.0)  # without a user, no rule has to say goodbye

    def read(self, events: Iterable[E], read: Callable[[E], Incoming | None]) -> list[Incoming]:
        """Read the messenger's events. Return the messages that `admits` accepts, and those of the kind ``left``.

        Args:
            events: The events.
            read: A function that returns the message in an event; None if the event does not concern the agent. If the
                function raises an exception, the room ignores the event, because anybody can send an event of any shape.
        """
        found: list[Incoming] = []
        for event in events:
            try:
                message = read(event)
            except Exception:  # each messenger's library has its own errors for an event of an unexpected shape
                self.log.exception("an event cannot be read, and is ignored")
                continue
            if message is not None and (message.kind == "left" or self.admits(message)):
                found.append(message)
        return found

    def admits(self, message: Incoming) -> bool:
        """Return whether the setting `allow` permits an answer to a message. Log a refusal once for each sender."""
        person = message.person
        if self._settings.allows(person.id, message.chat, *message.aliases):
            return True
        self.warn(person.id, f"({person.name}) is not in {self.name}.allow, and gets no answer")
        return False

    def warn(self, concerned: str, what: str) -> None:
        """Log a sentence as a warning, but only once for each beginning.

        Args:
            concerned: The beginning of the sentence: the person or the room that it is about.
            what: The rest of the sentence.
        """
        if concerned not in self._warned:
            self._warned.add(concerned)
            self.log.warning("%s %s", concerned, what)

    def receive(self, messages: Iterable[Incoming], position: tuple[str, str] | None = None) -> None:
        """Store messages from the messenger, and pass them to their chats. The caller may then acknowledge them.

        Args:
            messages: The messages, in order. The room ignores messages that it got before, and reactions to messages
                that the agent did not write.
            position: A name and a text to note in the same transaction, e.g. the position in a stream of events.

        Raises:
            sqlite3.Error: The file cannot be written. Do not acknowledge the messages, so that they come again.
        """
        with self.store.batch():
            entries = [entry for message in messages if (entry := self._taken(message)) is not None]
            if position is not None:
                self.store.note(*position)
        for entry in entries:
            if not self.closing:  # otherwise the next process takes the message
                self._give(entry)

    def _taken(self, message: Incoming) -> Entry | None:
        if message.kind == "reaction" and not self.store.wrote(message.chat, message.id):
            return None
        entry = self.store.take(message)
        if entry is not None and message.kind == "left":
            self.store.forget(message.chat)
        return entry

    def _give(self, entry: Entry) -> None:
        """Give a message to its chat. If the chat has ended or not begun, begin a new one."""
        id = entry.message.chat
        if entry.message.kind == "left":
            self._close(id)
            return
        chat = self._chats.get(id)
        if chat is None:
            chat = self._chats[id] = Chat(self, id)
            self._tasks[chat] = task = asyncio.create_task(self._run(chat))
            task.add_done_callback(lambda _: self._tasks.pop(chat))
        chat.take(entry)
        self.make_room()

    async def persist(self, operate: Callable[[], T]) -> T:
        """Return the result of an operation of the store. If the file cannot be written, try again until it can."""
        for attempt in itertools.count():
            try:
                return operate()
            except sqlite3.Error as error:
                self.log.warning("the chats' file cannot be written: %s", error)
                await asyncio.sleep(back_off(attempt))
        raise AssertionError("the loop ends with a result")

    async def _run(self, chat: Chat) -> None:
        try:
            await chat.live()
        except Exception:  # a fault in one chat must not end the others
            self.log.exception("%r failed", chat)
        finally:
            if self._chats.get(chat.id) is chat:
                del self._chats[chat.id]

    def make_room(self) -> None:
        """If too many chats are awake (not at rest), put idle chats to rest: the chats with the longest silence first."""
        if len(self._tasks) > self._limit:
            staying = [chat for chat in self._tasks if not chat.leaving]
            idle = sorted((chat for chat in staying if not chat.busy), key=lambda chat: chat.last_active)
            for chat in idle[: max(0, len(staying) - self._limit)]:
                chat.rest()

    def _close(self, id: str) -> None:
        """End a chat that the agent is no longer in."""
        if (chat := self._chats.pop(id, None)) is not None:
            chat.close()
            self._tasks[chat].cancel()

    def _gone(self, id: str) -> None:
        self.log.warning("chat %s is closed to the agent", id)
        self.store.forget(id)
        self._close(id)

    def _moved(self, id: str, to: str) -> None:
        self.log.info("chat %s is now chat %s", id, to)
        self.store.move(id, to)
        if id in self._chats:
            self._chats[id].rest()
        self.sender.wake(to)
