"""The web page passes the checks for platforms.

Conversations live in memory, so a crash would lose them. So these checks break all connections instead.
"""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable

import pytest

from modules.platform.webio.visit import Visit, in_virtual_time, page
from ravestate.testing import CHECKS, Driver, echo


class Visitor:
    """A visitor whose page reconnects, and then sends unconfirmed texts again."""

    def __init__(self) -> None:
        self.visit: Visit | None = None
        self.session = ""
        self.last = 0
        self.said: dict[str, str] = {}  # texts that are not confirmed yet, by id
        self.heard: list[str] = []
        self.news = asyncio.Event()
        self._number = 0
        self._reading: asyncio.Task[None] | None = None

    def say(self, text: str) -> None:
        self._number += 1
        self.said[f"say-{self._number}"] = text
        if self.visit is not None:
            self.visit.say(text, id=f"say-{self._number}")

    async def connect(self, visit: Visit) -> None:
        await visit.__aenter__()
        welcome = await visit.hello(**({"session": self.session, "last": self.last} if self.session else {}))
        self.session, self.visit = welcome["session"], visit
        for id, text in self.said.items():
            visit.say(text, id=id)
        self._reading = asyncio.create_task(self._read(visit))

    async def _read(self, visit: Visit) -> None:
        while True:
            frame = await visit.next()
            if frame["type"] != "message":
                continue
            self.last = frame["n"]
            if frame["from"] == "agent":
                self.heard.append(frame["text"])
                self.news.set()
            else:
                self.said.pop(frame["id"], None)

    async def cut(self) -> None:
        if self.visit is not None and self._reading is not None:
            self._reading.cancel()
            await self.visit.drop()
            self.visit = None


class Visitors:
    """A page in memory, and its visitors."""

    def __init__(self) -> None:
        self._visitors: dict[str, Visitor] = {}
        self._stack = contextlib.AsyncExitStack()

    async def __aenter__(self) -> None:
        self._app = await self._stack.enter_async_context(page(echo))

    async def __aexit__(self, *_: object) -> None:
        await self.kill()
        await self._stack.aclose()

    async def kill(self) -> None:
        for visitor in self._visitors.values():
            await visitor.cut()
        self._down = True

    async def restart(self) -> None:
        self._down = False
        for visitor in self._visitors.values():
            await visitor.connect(Visit(self._app))

    _down = False

    async def say(self, user: str, text: str) -> None:
        if user not in self._visitors:
            visitor = self._visitors[user] = Visitor()
            if not self._down:
                await visitor.connect(Visit(self._app))
        self._visitors[user].say(text)

    async def read(self, user: str, count: int) -> list[str]:
        visitor = self._visitors[user]
        while len(visitor.heard) < count:
            visitor.news.clear()
            await visitor.news.wait()
        return visitor.heard


@pytest.mark.parametrize("check", CHECKS)
def test_the_web_page_passes_the_checks_for_platforms(check: Callable[[Driver], Awaitable[None]]) -> None:
    @in_virtual_time
    async def test() -> None:
        await check(Visitors())

    test()
