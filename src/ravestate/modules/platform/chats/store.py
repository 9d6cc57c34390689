"""The store: a file with the unanswered incoming messages and the undelivered outgoing messages."""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import time
from collections.abc import Generator, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from ravestate.errors import PlatformError

from .messages import Incoming, Outgoing, Person

SEEN = 3 * 24 * 3600.0
"""How many seconds the store remembers the keys of messages. Messengers repeat a message for at most a day."""

WROTE = 30 * 24 * 3600.0
"""How many seconds the store remembers the ids of the agent's own messages."""

TRIES = 3
"""If the agent crashes this many times while it handles a message, the store drops the message as a likely cause."""

PARTING = ("stop", "forget")
"""The commands after which the agent treats the person as new in the chat."""

TABLES = """
CREATE TABLE IF NOT EXISTS inbox (
    n INTEGER PRIMARY KEY AUTOINCREMENT, key TEXT UNIQUE, chat TEXT, id TEXT, at REAL,
    tries INTEGER DEFAULT 0, answer TEXT DEFAULT '', data TEXT);
CREATE INDEX IF NOT EXISTS of_chat ON inbox (chat, id);
CREATE INDEX IF NOT EXISTS by_age ON inbox (at);
CREATE INDEX IF NOT EXISTS not_done ON inbox (chat) WHERE data IS NOT NULL;
CREATE TABLE IF NOT EXISTS outbox (
    n INTEGER PRIMARY KEY AUTOINCREMENT, chat TEXT, cause INTEGER, state TEXT DEFAULT 'queued', message TEXT, data BLOB);
CREATE INDEX IF NOT EXISTS to_send ON outbox (chat, state);
CREATE TABLE IF NOT EXISTS own (chat TEXT, id TEXT, at REAL, PRIMARY KEY (chat, id));
CREATE INDEX IF NOT EXISTS own_by_age ON own (at);
CREATE TABLE IF NOT EXISTS people (chat TEXT, id TEXT, PRIMARY KEY (chat, id));
CREATE TABLE IF NOT EXISTS notes (name TEXT PRIMARY KEY, value TEXT);
"""


@dataclass(frozen=True, slots=True)
class Entry:
    """An incoming message with its number in the store."""

    n: int
    message: Incoming


@dataclass(frozen=True, slots=True)
class Item:
    """An outgoing message with its number in the store. `begun` is True if an attempt may have delivered it."""

    n: int
    message: Outgoing
    begun: bool


@dataclass(frozen=True, slots=True)
class Answer:
    """A message that the agent wants to send, and the number of the incoming message that it answers.

    The number is None if the agent speaks on its own initiative.
    """

    message: Outgoing
    cause: int | None = None


class Store:
    """Messages in a SQLite file. Only one process at a time may open the file.

    Each operation is one transaction. If the process dies, no finished transaction is lost. After a power failure, the
    last transactions may be missing. An operation takes about 0.1 ms, so it runs on the event loop.

    Args:
        path: The file. The store makes the file and its folder if they are missing. Only the user may read the file.

    Raises:
        PlatformError: The file cannot be used: another process has it open, or it is damaged, or it is not a store.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
            self._db = sqlite3.connect(path, isolation_level=None, timeout=0.0)
        except (sqlite3.Error, OSError) as error:
            raise _not_opened(path, error) from None
        try:
            self._prepare()
        except BaseException as error:
            self._db.close()
            if isinstance(error, sqlite3.Error):
                raise _not_opened(path, error) from None
            raise

    def _prepare(self) -> None:
        """Lock the file, check it, and create the missing tables."""
        self._db.execute("PRAGMA locking_mode=EXCLUSIVE")
        self._check()
        self._db.execute("PRAGMA journal_mode=WAL")
        self._db.execute("PRAGMA synchronous=NORMAL")
        self._db.execute("PRAGMA secure_delete=ON")
        with self._transaction():
            for statement in TABLES.split(";"):
                self._db.execute(statement)
            self._purge()

    def _check(self) -> None:
        """Refuse a damaged file, and the file of another program, before a message is lost in it."""
        if self._all("PRAGMA quick_check(1)") != [("ok",)]:
            raise sqlite3.DatabaseError("it is damaged")
        tables = {name for (name,) in self._all("SELECT name FROM sqlite_master WHERE type = 'table'")}
        if tables and "outbox" not in tables:
            raise sqlite3.DatabaseError("it belongs to another program")

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    @contextlib.contextmanager
    def _transaction(self) -> Generator[None]:
        if self._db.in_transaction:  # the operation is part of a batch
            yield
            return
        self._db.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._db.execute("COMMIT")
        except BaseException:
            if self._db.in_transaction:  # SQLite itself may have rolled the transaction back
                self._db.execute("ROLLBACK")
            raise

    batch = _transaction
    """A context manager that makes the operations inside its ``with`` block one transaction."""

    def _all(self, query: str, *values: object) -> list[Any]:
        return self._db.execute(query, values).fetchall()

    # ------------------------------------------------------------------------------------ messages that came

    def _purge(self) -> None:
        """Delete the keys of old messages, and the ids of old messages of the agent."""
        self._db.execute("DELETE FROM inbox WHERE at < ? AND data IS NULL", (time.time() - SEEN,))
        self._db.execute("DELETE FROM own WHERE at < ?", (time.time() - WROTE,))

    def take(self, message: Incoming) -> Entry | None:
        """Store a message until it is done. Return its entry, or None if a message with this key came before."""
        with self._transaction():
            self._purge()
            data = json.dumps(asdict(message))
            id = None if message.kind == "reaction" else message.id  # a reaction has the id of another message
            cursor = self._db.execute(
                "INSERT OR IGNORE INTO inbox (key, chat, id, at, data) VALUES (?, ?, ?, ?, ?)",
                (message.key, message.chat, id, time.time(), data),
            )
            return Entry(cursor.lastrowid or 0, message) if cursor.rowcount else None

    def pending(self) -> list[Entry]:
        """Return the messages that are not done, in order. Drop messages that the agent has heard `TRIES` times."""
        with self._transaction():
            self._db.execute("UPDATE inbox SET data = NULL WHERE tries >= ?", (TRIES,))
            self._tidy("chat")
            return [
                Entry(n, _incoming(data, chat))
                for n, data, chat in self._all("SELECT n, data, chat FROM inbox WHERE data IS NOT NULL ORDER BY n")
            ]

    def hear(self, entry: Entry, edits: Sequence[Entry] = ()) -> Entry:
        """Note that the agent hears a message. Return the message with the text of its last edit."""
        if edits:
            entry = replace(entry, message=replace(entry.message, text=edits[-1].message.text))
        with self._transaction():
            data = json.dumps(asdict(entry.message))
            self._db.execute(
                "UPDATE inbox SET data = ?, tries = tries + 1 WHERE n = ? AND data IS NOT NULL", (data, entry.n)
            )
            for edit in edits:
                self._db.execute("UPDATE inbox SET data = NULL WHERE n = ?", (edit.n,))
        return entry

    def unhear(self, entries: Iterable[Entry]) -> None:
        """Take back the attempt that `hear` has counted for messages, because the process ends without a crash."""
        with self._transaction():
            for entry in entries:
                self._db.execute("UPDATE inbox SET tries = tries - 1 WHERE n = ?", (entry.n,))

    def answers_to(self, edit: Entry) -> list[str] | None:
        """Return the ids of the answers to the edited text; an empty list if there are none yet.

        If the edited message was not the last message of its chat, return None.
        """
        chat, id = edit.message.chat, edit.message.id
        query = "SELECT id FROM inbox WHERE chat = ? AND n < ? AND id IS NOT NULL ORDER BY n DESC LIMIT 1"
        if self._all(query, chat, edit.n) != [(id,)]:
            return None
        query = "SELECT answer FROM inbox WHERE chat = ? AND id = ? AND n < ? ORDER BY n"
        return [answer for (answers,) in self._all(query, chat, id, edit.n) for answer in answers.split("\n") if answer]

    # ------------------------------------------------------------------------------------ messages to deliver

    def commit(self, answers: Iterable[Answer], done: Sequence[Entry] = ()) -> None:
        """Queue answers, and mark incoming messages as done, in one transaction.

        The senders of the messages then count as known in their chats, or as unknown after a command in `PARTING`.
        """
        with self._transaction():
            for answer in answers:
                self._db.execute(
                    "INSERT INTO outbox (chat, cause, message, data) VALUES (?, ?, ?, ?)",
                    (answer.message.chat, answer.cause, _json(answer.message), answer.message.data),
                )
            for entry in done:
                self._db.execute("UPDATE inbox SET data = NULL WHERE n = ?", (entry.n,))
                message = entry.message
                self._tidy("?", message.chat)
                parting = message.kind == "command" and message.text in PARTING
                change = (
                    "DELETE FROM people WHERE chat = ? AND id = ?"
                    if parting
                    else "INSERT OR IGNORE INTO people VALUES (?, ?)"
                )
                self._db.execute(change, (message.chat, message.person.id))

    def recorded(self, cause: int) -> list[Outgoing]:
        """Return the answers to a message that is not done, whether or not they are delivered."""
        return [_outgoing(*row) for row in self._all("SELECT message, data, chat FROM outbox WHERE cause = ?", cause)]

    def alone(self, chat: str) -> list[Outgoing]:
        """Return the messages that the agent has written to a chat on its own initiative.

        The store keeps a delivered message only while incoming messages of its chat are not done.
        """
        query = "SELECT message, data, chat FROM outbox WHERE cause IS NULL AND chat = ?"
        return [_outgoing(*row) for row in self._all(query, chat)]

    def _tidy(self, chat: str, *values: str) -> None:
        """Delete the delivered messages that no crash can make the agent repeat."""
        needed = "SELECT 1 FROM inbox i WHERE i.data IS NOT NULL AND i.chat = outbox.chat AND i.n = ifnull(cause, i.n)"
        self._db.execute(f"DELETE FROM outbox WHERE chat = {chat} AND state = 'sent' AND NOT EXISTS ({needed})", values)

    def chats_to_send(self) -> list[str]:
        """Return the ids of the chats with undelivered messages."""
        return [chat for (chat,) in self._all("SELECT DISTINCT chat FROM outbox WHERE state != 'sent' ORDER BY n")]

    def next(self, chat: str) -> Item | None:
        """Return the chat's oldest undelivered message; None if there is none."""
        query = "SELECT n, message, data, state FROM outbox WHERE chat = ? AND state != 'sent' ORDER BY n LIMIT 1"
        for n, message, data, state in self._all(query, chat):
            return Item(n, _outgoing(message, data, chat), state == "begun")
        return None

    def has(self, item: Item) -> bool:
        """Return whether an outgoing message is still in the store."""
        return bool(self._all("SELECT 1 FROM outbox WHERE n = ?", item.n))

    def begin(self, item: Item, trace: str) -> Item:
        """Note that an attempt to deliver an item begins. Return the item with `trace` (see `Carrier.trace`)."""
        message = replace(item.message, trace=trace)
        with self._transaction():
            self._db.execute("UPDATE outbox SET state = 'begun', message = ? WHERE n = ?", (_json(message), item.n))
        return Item(item.n, message, True)

    def undo(self, item: Item) -> None:
        """Note that no attempt has delivered the message."""
        with self._transaction():
            self._db.execute("UPDATE outbox SET state = 'queued' WHERE n = ?", (item.n,))

    def write_out(self, item: Item) -> None:
        """Turn a voice note that was refused into a text."""
        message = replace(item.message, kind="text", trace="")
        with self._transaction():
            self._db.execute("UPDATE outbox SET state = 'queued', message = ? WHERE n = ?", (_json(message), item.n))

    def sent(self, item: Item, id: str) -> None:
        """Note that a message has been delivered, and has this id on the messenger."""
        with self._transaction():
            message = item.message
            cause = "(SELECT cause FROM outbox WHERE n = ?)"
            if message.kind not in ("reaction", "delete"):
                self._db.execute("INSERT OR REPLACE INTO own VALUES (?, ?, ?)", (message.chat, id, time.time()))
            if message.kind in ("text", "voice"):
                self._db.execute(f"UPDATE inbox SET answer = answer || ? WHERE n = {cause}", (f"\n{id}", item.n))
            elif message.kind in ("edit", "delete"):
                new = [id] if message.kind == "edit" else []  # after a failed edit, the answer is a new message
                same = f"chat = ? AND id = (SELECT id FROM inbox WHERE n = {cause})"
                for n, answers in self._all(f"SELECT n, answer FROM inbox WHERE {same}", message.chat, item.n):
                    lines = [each for line in answers.split("\n") for each in (new if line == message.to else [line])]
                    self._db.execute("UPDATE inbox SET answer = ? WHERE n = ?", ("\n".join(lines), n))
                message = replace(message, to=id)
            self._db.execute("UPDATE outbox SET state = 'sent', message = ? WHERE n = ?", (_json(message), item.n))
            self._tidy("?", message.chat)

    def drop(self, item: Item) -> None:
        """Delete an outgoing message."""
        with self._transaction():
            self._db.execute("DELETE FROM outbox WHERE n = ?", (item.n,))

    def wrote(self, chat: str, id: str) -> bool:
        """Return whether the agent wrote the message with this id in the last `WROTE` seconds.

        During a delivery, the id of the new message is not known yet. So an id without a known message may be its id:
        then return True.
        """
        if self._all("SELECT 1 FROM own WHERE chat = ? AND id = ?", chat, id):
            return True
        if self._all("SELECT 1 FROM inbox WHERE chat = ? AND id = ?", chat, id):
            return False
        return bool(self._all("SELECT 1 FROM outbox WHERE chat = ? AND state = 'begun' LIMIT 1", chat))

    # ------------------------------------------------------------------------------------ chats, people and notes

    def knows(self, chat: str, person: Person) -> bool:
        """Return whether the agent has handled a message of this person in this chat, since their last `PARTING` command."""
        return bool(self._all("SELECT 1 FROM people WHERE chat = ? AND id = ?", chat, person.id))

    def forget(self, chat: str) -> None:
        """Delete the people in a chat, and all its messages except their keys, by which `take` recognises repetitions."""
        with self._transaction():
            self._db.execute("DELETE FROM people WHERE chat = ?", (chat,))
            self._db.execute("DELETE FROM outbox WHERE chat = ?", (chat,))
            self._db.execute("DELETE FROM own WHERE chat = ?", (chat,))
            self._db.execute("UPDATE inbox SET data = NULL WHERE chat = ?", (chat,))

    def move(self, chat: str, to: str) -> None:
        """Give a chat another id. Deliveries that have begun start again under the new id.

        The agent's earlier messages keep the old id of the chat, because the new chat may number its messages anew.
        """
        with self._transaction():
            self._db.execute("UPDATE outbox SET state = 'queued' WHERE chat = ? AND state = 'begun'", (chat,))
            for table in ("inbox", "outbox", "people"):
                self._db.execute(f"UPDATE OR IGNORE {table} SET chat = ? WHERE chat = ?", (to, chat))

    def note(self, name: str, value: str) -> None:
        """Store a text under a name, e.g. the position in the messenger's stream of events."""
        with self._transaction():
            self._db.execute("INSERT OR REPLACE INTO notes VALUES (?, ?)", (name, value))

    def noted(self, name: str) -> str | None:
        """Return the text under a name; None if there is none."""
        return next((value for (value,) in self._all("SELECT value FROM notes WHERE name = ?", name)), None)


def _not_opened(path: Path, error: Exception) -> PlatformError:
    """Return the message for users about a file that cannot be opened, with the reason and the remedy."""
    why = error.strerror if isinstance(error, OSError) else str(error)
    mend = "name another file in the messenger's setting path, or move this one away (its messages are then lost)"
    if getattr(error, "sqlite_errorname", "").startswith("SQLITE_BUSY"):
        why, mend = "another agent uses it", "end that agent first"
    return PlatformError(f"the chats' file {path} cannot be opened: {why}: {mend}")


def _incoming(data: str, chat: str) -> Incoming:
    fields: dict[str, Any] = json.loads(data)
    fields.update(chat=chat, person=Person(**fields["person"]), aliases=tuple(fields.get("aliases", ())))
    return Incoming(**fields)


def _json(message: Outgoing) -> str:
    return json.dumps({name: value for name, value in asdict(message).items() if name != "data"})


def _outgoing(message: str, data: bytes, chat: str) -> Outgoing:
    fields: dict[str, Any] = json.loads(message)
    fields.update(chat=chat, data=bytes(data))
    return Outgoing(**fields)
