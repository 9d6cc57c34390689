"""The room: all chats of an agent on one messenger."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Iterable
from typing import TYPE_CHECKING, Any

from ravestate.errors import PlatformError

from .chat import Chat
from .messages import Carrier, Incoming
from .sender import Sender

if TYPE_CHECKING:
    import ravestate as rs
    from ravestate.runtime.agent import Agent

    from .commands import Command
    from .store import Store

LAST_WORDS = 5.0
"""The seconds that the agent has to answer and to send when it ends. The rest is done at the next start."""


async def _no_words(_: bytes) -> str:
    raise PlatformError("this platform has no speech recognition")


class Room:
    """All chats of an agent on a messenger: ``async with Room(agent, ...) as room``, then `receive` each message.

    On entry, the room takes up the messages that were left when the last process ended.

    Args:
        agent: The agent, which makes a context for each chat.
        name: The platform's name: the first part of the users' keys and of the log's name.
        carrier: The connection to the messenger.
        store: The file of messages. The room closes it.
        slot: The slot of the platform's module that holds the `Chat` in each context.
        command: The signal of the platform's module for commands.
        rest: The seconds of silence after which a chat is put to rest.
        limit: The maximum number of chats that do not rest. Beyond it, the chat that was silent longest is put to rest.
        transcribe: A function that returns the words in a voice note. It raises `PlatformError` if it cannot.
    """

    def __init__(
        self,
        agent: Agent,
        *,
        name: str,
        carrier: Carrier,
        store: Store,
        slot: rs.Slot[Any],
        command: rs.Signal[Command],
        rest: float = 600.0,
        limit: int = 1000,
        transcribe: Callable[[bytes], Awaitable[str]] = _no_words,
    ) -> None:
        self.agent = agent
        self.name = name
        self.carrier = carrier
        self.store = store
        self.slot = slot
        self.command = command
        self.rest = rest
        self.transcribe = transcribe
        self.log = logging.getLogger(f"ravestate.{name}")
        self.closing = False
        """Whether the agent is being switched off."""
        self.sender = Sender(store, carrier, self._gone, self._moved, self.log)
        self._limit = limit
        self._chats: dict[str, Chat] = {}
        self._tasks: dict[str, asyncio.Task[None]] = {}

    def __len__(self) -> int:
        """Return the number of chats that do not rest."""
        return len(self._tasks)

    async def __aenter__(self) -> Room:
        for chat in self.store.chats_to_send():
            self.sender.wake(chat)
        for entry in self.store.pending():
            self._give(entry.message.chat).take(entry)
        return self

    async def __aexit__(self, *_: object) -> None:
        """Put all chats to rest, and deliver their last messages."""
        self.closing = True
        try:
            for chat in self._chats.values():
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

    def receive(self, messages: Iterable[Incoming], position: tuple[str, str] | None = None) -> None:
        """Take messages from the messenger. After the call they are kept, and may be acknowledged.

        Args:
            messages: The messages, in order. The room ignores those that it got before.
            position: A name and a text to note in the same transaction, e.g. the position in a stream of events.
        """
        with self.store.batch():
            entries = [entry for message in messages if (entry := self.store.take(message)) is not None]
            if position is not None:
                self.store.note(*position)
        for entry in entries:
            if not self.closing:  # otherwise the next process takes it up
                self._give(entry.message.chat).take(entry)

    def _give(self, id: str) -> Chat:
        """Return a chat that does not rest."""
        chat = self._chats.get(id)
        if chat is None:
            self._make_room()
            chat = self._chats[id] = Chat(self, id)
            self._tasks[id] = asyncio.create_task(self._run(chat))
        return chat

    async def _run(self, chat: Chat) -> None:
        try:
            await chat.live()
        except Exception:
            self.log.exception("%r failed", chat)
        finally:
            if self._chats.get(chat.id) is chat:
                del self._chats[chat.id], self._tasks[chat.id]

    def _make_room(self) -> None:
        if len(self._tasks) >= self._limit:
            idle = [chat for chat in self._chats.values() if not chat.busy]
            if idle:
                min(idle, key=lambda chat: chat.last_active).rest()

    def _gone(self, id: str) -> None:
        self.log.warning("chat %s is closed to the agent", id)
        self.store.forget(id)
        if id in self._chats:
            self._chats[id].close()

    def _moved(self, id: str, to: str) -> None:
        self.log.info("chat %s is now chat %s", id, to)
        self.store.move(id, to)
        if id in self._chats:
            self._chats[id].rest()
        self.sender.wake(to)
