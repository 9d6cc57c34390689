"""Matrix passes the checks of platforms, with the agent in a process of its own, on a real homeserver."""

import asyncio
import contextlib
import os
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path

import httpx
import pytest

from modules.platform.matrixio.conftest import Account, Homeserver, register
from ravestate.testing import CHECKS, Driver


class Users:
    """The users of a homeserver, each in a room with the agent, which runs in a process of its own."""

    def __init__(self, server: Homeserver, folder: Path) -> None:
        self._server = server
        self._folder = folder
        self._users: dict[str, tuple[Account, str]] = {}
        self._process: asyncio.subprocess.Process | None = None

    async def __aenter__(self) -> None:
        self._http = httpx.AsyncClient(timeout=60.0, trust_env=False)
        self._robin = await register(self._server, self._http, "Robin")
        await self.restart()

    async def __aexit__(self, *_: object) -> None:
        await self.kill()
        await self._http.aclose()

    async def restart(self) -> None:
        environment = {
            **os.environ,
            "RAVESTATE_MATRIXIO_HOMESERVER": self._server.url,
            "RAVESTATE_MATRIXIO_USER": self._robin.id,
            "RAVESTATE_MATRIXIO_PASSWORD": "password",
            "RAVESTATE_MATRIXIO_PATH": str(self._folder / "chats.sqlite"),
        }
        self._process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "ravestate", "run", "matrixio", "ravestate.testing.platforms:echo", env=environment
        )

    async def kill(self) -> None:
        assert self._process is not None
        with contextlib.suppress(ProcessLookupError):
            self._process.kill()
        await self._process.wait()

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
def test_matrix_conforms(check: Callable[[Driver], Awaitable[None]], homeserver: Homeserver, tmp_path: Path) -> None:
    asyncio.run(check(Users(homeserver, tmp_path)))
