"""A stand-in for a messenger, in memory and virtual time. It keeps the agent's messages, and fails on demand."""

import asyncio
import contextlib
import itertools
from collections import Counter
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any

import ravestate as rs
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.chats import (
    Chat,
    ChatSettings,
    Command,
    DeliveryError,
    Incoming,
    Outgoing,
    Person,
    Room,
    connect,
)
from ravestate.runtime.agent import Agent

letters = rs.Module("letters", requires=(rawio, interloc), settings=ChatSettings)
chat: rs.Slot[Chat | None] = letters.slot("chat", None)
command: rs.Signal[Command] = letters.signal("command", payload=Command, input=True)
connect(letters, chat, command)

parrot = rs.Module("parrot", requires=(rawio, interloc))


@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = ctx.payload(rawio.input.changed)


@parrot.rule(when=interloc.users.added, writes=rawio.output)
async def greet(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = f"Hello {ctx.payload(interloc.users.added).item}!"


class Post:
    """A stand-in for a messenger.

    Each call of `send`, `fetch` or `show_work` raises the next error in `failures`, until the list is empty.
    """

    longest = 100
    longest_caption = 50
    rate = 1000.0

    def __init__(self) -> None:
        self.sent: list[Outgoing] = []
        self.failures: list[Exception] = []
        self.files: dict[str, bytes] = {}
        self.shown: list[tuple[float, str]] = []
        self.attempts: list[tuple[float, str]] = []
        self.news = asyncio.Condition()

    async def send(self, message: Outgoing, again: bool) -> str:
        self.attempts.append((asyncio.get_running_loop().time(), message.chat))
        if self.failures:
            raise self.failures.pop(0)
        if again:
            known = [n for n, each in enumerate(self.sent) if each.key == message.key]
            if known:
                return str(known[0])
        self.sent.append(message)
        async with self.news:
            self.news.notify_all()
        return f"answer {len(self.sent)}"

    def trace(self, chat: str) -> str:
        return ""

    async def fetch(self, file: str) -> bytes:
        if self.failures:
            raise self.failures.pop(0)
        if file not in self.files:
            raise DeliveryError("there is no such file", final=True)
        return self.files[file]

    async def show_work(self, chat: str, words: str) -> None:
        self.shown.append((asyncio.get_running_loop().time(), words))
        if self.failures:
            raise self.failures.pop(0)

    def can_react(self, emoji: str) -> bool:
        return emoji == "👍"

    async def said(self, count: int) -> list[str]:
        """Wait until the agent has sent `count` messages; return them as "chat: text"."""
        async with self.news:
            await self.news.wait_for(lambda: len(self.sent) >= count)
        return [f"{each.chat}: {each.text}" for each in self.sent]


_keys = itertools.count()


def letter(text: str = "", chat: str = "a", **fields: Any) -> Incoming:
    """Return a message from the user of a chat."""
    n = str(next(_keys))
    base: dict[str, Any] = {"key": n, "id": n, "person": Person(chat, chat.upper())}
    return Incoming(**{**base, "chat": chat, "text": text, **fields})


class KeepingAgent(Agent):
    """An agent that keeps its contexts, oldest first, for the test."""

    def __init__(self, *modules: Any, **options: Any) -> None:
        super().__init__(*modules, **options)
        self.contexts: list[rs.Context] = []

    def context(self, **options: Any) -> rs.Context:
        self.contexts.append(super().context(**options))
        return self.contexts[-1]


@contextlib.asynccontextmanager
async def room(path: Path, post: Post, *modules: Any, **settings: Any) -> AsyncGenerator[Room]:
    """Open the room of an agent. If no modules are given, the agent greets users and repeats their messages."""
    settings = {"letters": {"path": path / "letters.db", **settings}}
    agent = KeepingAgent(*(modules or (parrot,)), letters, settings=settings)
    async with Room(agent, "letters", post, "me") as opened:
        yield opened


def counted(said: list[str]) -> Counter[str]:
    return Counter(said)
