"""Matrix passes the checks for platforms, with the agent in a separate process, on a real homeserver."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import httpx
import pytest

from modules.platform.matrixio.conftest import Account, Homeserver, register
from modules.platform.matrixio.test_restart import robin
from ravestate.testing import CHECKS, Driver


class Users:
    """An agent in a separate process, and users of a homeserver, each in their own room with the agent."""

    def __init__(self, server: Homeserver, folder: Path) -> None:
        self._server = server
        self._folder = folder
        self._users: dict[str, tuple[Account, str]] = {}

    async def __aenter__(self) -> None:
        self._http = httpx.AsyncClient(timeout=60.0, trust_env=False)
        self._robin = await register(self._server, self._http, "Robin")
        self._process = robin(self._robin, self._folder)
        await self.restart()

    async def __aexit__(self, *_: object) -> None:
        await self.kill()
        await self._http.aclose()

    async def restart(self) -> None:
        await self._process.start()

    async def kill(self) -> None:
        await self._process.kill()

    async def say(self, user: str, text: str) -> None:
        if user not in self._users:
            account = await register(self._server, self._http, user)
            self._users[user] = account, await account.room(self._robin.id)
        account, room = self._users[user]
        await account.say(room, text)

    async def read(self, user: str, count: int) -> list[str]:
        account, room = self._users[user]
        return [each.removeprefix(f"{room}: ") for each in await account.listen(count)]


@pytest.mark.parametrize("check", CHECKS)
def test_matrix_passes_the_checks_for_platforms(
    check: Callable[[Driver], Awaitable[None]], homeserver: Homeserver, tmp_path: Path
) -> None:
    asyncio.run(check(Users(homeserver, tmp_path)))
