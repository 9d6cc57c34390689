"""Telegram passes the checks of platforms, with the agent in a process of its own."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from modules.platform.telegramio.conftest import Bot
from modules.platform.telegramio.test_restart import start
from ravestate.testing import CHECKS, Driver


class Users:
    """The users of a bot whose agent runs in a process of its own."""

    def __init__(self, bot: Bot, folder: Path) -> None:
        self._bot = bot
        self._folder = folder
        self._chats: dict[str, int] = {}
        self._process: asyncio.subprocess.Process | None = None

    async def __aenter__(self) -> None:
        await self.restart()

    async def __aexit__(self, *_: object) -> None:
        await self.kill()

    async def restart(self) -> None:
        self._process = await start(self._bot, self._folder, "ravestate.testing.platforms:echo")

    async def kill(self) -> None:
        assert self._process is not None
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()
        await self._process.wait()

    async def say(self, user: str, text: str) -> None:
        await self._bot.say(self._chats.setdefault(user, len(self._chats) + 1), text)

    async def read(self, user: str, count: int) -> list[str]:
        chat = self._chats[user]
        while True:
            said = await self._bot.do("said", count=0)
            mine = [message["text"] for message in said if message["chat"]["id"] == chat]
            if len(mine) >= count:
                return mine
            await self._bot.do("said", count=len(said) + 1)


@pytest.mark.parametrize("check", CHECKS)
def test_telegram_conforms(check: Callable[[Driver], Awaitable[None]], bot: Bot, tmp_path: Path) -> None:
    asyncio.run(check(Users(bot, tmp_path)))  # type: ignore[arg-type]
