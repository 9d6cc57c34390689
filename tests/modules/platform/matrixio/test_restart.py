"""The agent or the homeserver dies in the middle of 20 conversations: no message is lost, and none is answered twice."""

import asyncio
import contextlib
import os
import random
import sys
from pathlib import Path

from modules.platform.matrixio.conftest import Account, Homeserver, accounts
from ravestate.testing.platforms import PATIENCE


class Robin:
    """The agent ``echo`` in a process of its own: ``async with`` starts it, and kills it at the end."""

    def __init__(self, account: Account, folder: Path) -> None:
        self._account = account
        self._folder = folder
        self._process: asyncio.subprocess.Process | None = None

    async def __aenter__(self) -> "Robin":
        await self.start()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.kill()

    async def start(self) -> None:
        environment = {
            **os.environ,
            "RAVESTATE_MATRIXIO_HOMESERVER": self._account.server.url,
            "RAVESTATE_MATRIXIO_USER": self._account.id,
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


def test_twenty_rooms_outlive_kills_of_the_agent_and_of_the_server(homeserver: Homeserver, tmp_path: Path) -> None:
    chance = random.Random(7)

    async def test() -> None:
        async with asyncio.timeout(2 * PATIENCE), accounts(homeserver, "Robin", "Ada") as (account, ada):
            rooms = await asyncio.gather(*(ada.room(account.id) for _ in range(20)))

            async def say(n: int) -> None:
                await asyncio.gather(*(ada.say(room, f"{n} in {room}") for room in rooms))

            await say(0)
            async with Robin(account, tmp_path) as robin:
                await ada.listen(chance.randrange(2, 18))
                await robin.kill()
                await say(1)  # while the agent is down
                await robin.start()
                await ada.listen(chance.randrange(22, 38))
                homeserver.kill()
                homeserver.start()
                await say(2)
                await ada.listen(chance.randrange(42, 58))
                await robin.kill()
                await robin.start()
                await ada.listen(60)
                await ada.say(rooms[0], "the last")
                said = await ada.listen(61)
            for room in rooms:
                mine = [each.removeprefix(f"{room}: ") for each in said if each.startswith(room)]
                assert mine == [f"{n} in {room}" for n in range(3)] + ["the last"] * (room == rooms[0])

    asyncio.run(test())
