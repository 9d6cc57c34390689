"""Telegram passes the checks for platforms, with the agent in a separate process."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from modules.platform.telegramio.conftest import Bot
from modules.platform.telegramio.test_restart import robin
from ravestate.testing import CHECKS, Driver


class Users:
    """An agent in a separate process, and the users of its bot."""

    def __init__(self, bot: Bot, folder: Path) -> None:
        self._bot = bot
        self._agent = robin(bot, folder, "ravestate.testing.platforms:echo")
        self._chats: dict[str, int] = {}

    async def __aenter__(self) -> None:
        await self.restart()

    async def __aexit__(self, *_: object) -> None:
        await self.kill()

    async def restart(self) -> None:
        await self._agent.start()

    async def kill(self) -> None:
        await self._agent.kill()

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
def test_telegram_passes_the_checks_for_platforms(
    check: Callable[[Driver], Awaitable[None]], bot: Bot, tmp_path: Path
) -> None:
    asyncio.run(check(Users(bot, tmp_path)))
