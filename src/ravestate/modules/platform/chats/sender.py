"""The sender: it delivers the messages in a store, in order within each chat, and tries again after failures."""

from __future__ import annotations

import asyncio
import logging
import sqlite3
from collections.abc import Callable

from .attempts import Attempts
from .messages import Carrier, DeliveryError
from .store import Item, Store
from .voice import voiced

IN_FLIGHT = 8
"""The maximum number of deliveries at a time. So a crash interrupts at most this many deliveries."""

SHOWN = 2.0
"""A message waits at most this many seconds for the end of a request that shows its draft."""

BURST = 0.15
"""After a pause, the first turns (see `Pace`) need no wait: the turns that fit into this many seconds (about 4 at 25 per
second)."""


class Pace:
    """A rate limit: each request needs a turn. There are at most `rate` turns per second.

    ``await pace.turn()`` waits for the next turn.
    """

    def __init__(self, rate: float) -> None:
        self._gap = 1.0 / rate
        self._next = 0.0

    async def turn(self) -> None:
        """Wait for a turn. After a pause, the first few turns need no wait."""
        now = asyncio.get_running_loop().time()
        self._next = max(self._next + self._gap, now - BURST)
        if self._next > now:
            await asyncio.sleep(self._next - now)

    def spare(self) -> bool:
        """Take a turn if it needs no wait. Return whether it was taken."""
        now = asyncio.get_running_loop().time()
        if self._next + self._gap > now:
            return False
        self._next = max(self._next + self._gap, now - BURST)
        return True


class Sender:
    """Delivers the messages of a store through a carrier. Each chat is a queue: a failure delays only its own chat.

    Args:
        store: The messages.
        carrier: The connection to the messenger.
        on_gone: A function to call with the id of a chat that is closed to the agent.
        on_moved: A function to call with the old and the new id of a chat.
        log: The logger of the platform.
    """

    def __init__(
        self,
        store: Store,
        carrier: Carrier,
        on_gone: Callable[[str], None],
        on_moved: Callable[[str, str], None],
        log: logging.Logger,
    ) -> None:
        self._store = store
        self._carrier = carrier
        self._on_gone = on_gone
        self._on_moved = on_moved
        self._log = log
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._showing: dict[str, asyncio.Task[None]] = {}
        self._attempts = asyncio.Semaphore(IN_FLIGHT)
        self.pace = Pace(carrier.rate)
        """The pace of all requests that count towards the messenger's limit."""

    async def show_work(self, chat: str, words: str) -> None:
        """Show in a chat that the agent is writing.

        While an earlier request for the chat runs, do nothing. The next message waits until the request has ended, but at
        most `SHOWN` seconds. The request runs on even if the caller is cancelled.

        Raises:
            DeliveryError: The request has failed.
        """

        def shown(task: asyncio.Task[None]) -> None:
            del self._showing[chat]
            if not task.cancelled():
                task.exception()  # retrieve the exception, even if no task waits for it any longer

        if chat not in self._showing:
            task = self._showing[chat] = asyncio.create_task(self._carrier.show_work(chat, words))
            task.add_done_callback(shown)
            await asyncio.shield(task)

    def wake(self, chat: str) -> None:
        """Deliver the messages that the store has for a chat."""
        if chat not in self._tasks:
            self._tasks[chat] = asyncio.create_task(self._deliver(chat))

    async def _deliver(self, chat: str) -> None:
        try:
            await self._drain(chat)
        except Exception:  # a fault in one chat must not end the others
            self._log.exception("the messages to chat %s are not sent", chat)
        finally:
            del self._tasks[chat]  # no `await` between `_drain` and this line, so `wake` overlooks no new message

    async def close(self, grace: float) -> None:
        """Deliver messages for up to `grace` seconds; the rest stays in the store."""
        if self._tasks:
            await asyncio.wait(list(self._tasks.values()), timeout=grace)
        tasks = [*self._tasks.values(), *self._showing.values()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _drain(self, chat: str) -> None:
        attempts = Attempts(self._log, f"chat {chat}")
        while True:
            try:
                item = self._store.next(chat)
                error = None if item is None else await self._attempt(item)
                if item is None:
                    return
                if error is not None and not self._store.has(item):  # the chat was closed meanwhile
                    error = None
                if error is not None and self._is_elsewhere(chat, error):
                    return
                if error is not None and error.final:
                    self._give_up(item, error)
                    error = None
            except sqlite3.Error as failure:
                error = DeliveryError(f"the chats' file cannot be written: {failure}")
            if error is None:
                attempts.succeed()
            else:
                await attempts.fail(error, error.wait)

    def _is_elsewhere(self, chat: str, error: DeliveryError) -> bool:
        """Call `on_gone` or `on_moved` if an error says that the chat is closed or has a new id. Return whether it does."""
        if error.gone:
            self._on_gone(chat)
        elif error.moved:
            self._on_moved(chat, error.moved)
        return error.gone or bool(error.moved)

    def _give_up(self, item: Item, error: DeliveryError) -> None:
        """Drop a message that was refused. If it is a voice note, send its words as a text instead."""
        if item.message.kind == "voice":
            self._log.info("a voice note was refused, and is sent as text: %s", error)
            self._store.write_out(item)
        else:
            self._log.error("a message was refused: %s", error)
            self._store.drop(item)

    async def _attempt(self, item: Item) -> DeliveryError | None:
        """Try to deliver an item once. Return the error if the attempt fails."""
        async with self._attempts:
            await self.pace.turn()
            if (showing := self._showing.get(item.message.chat)) is not None:  # a draft after the message would stay
                await asyncio.wait((showing,), timeout=SHOWN)
            begun = item if item.begun else self._store.begin(item, self._carrier.trace(item.message.chat))
            try:
                id = await self._carrier.send(await voiced(begun.message), item.begun)
            except DeliveryError as error:
                if not (item.begun or error.unsure):
                    self._store.undo(begun)
                return error
            except Exception as error:  # a mistake in the platform: the chat continues without the message
                self._log.exception("a message was not sent")
                return DeliveryError(repr(error), final=True)
            self._store.sent(begun, id)
        return None
