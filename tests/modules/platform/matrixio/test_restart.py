"""The agent and the homeserver are killed during 20 conversations. Each message still gets exactly one answer."""

import asyncio
import random
from pathlib import Path

from modules.platform.chats.process import AgentProcess
from modules.platform.matrixio.conftest import Account, Homeserver, accounts
from ravestate.testing.platforms import PATIENCE


def robin(account: Account, folder: Path) -> AgentProcess:
    """Return the agent ``echo`` in a separate process."""
    return AgentProcess(
        "matrixio", "ravestate.testing.platforms:echo",
        homeserver=account.server.url, user=account.id, password="password", path=folder / "chats.sqlite",
    )  # fmt: skip


def test_no_message_is_lost_or_answered_twice_when_agent_and_server_are_killed(
    homeserver: Homeserver, tmp_path: Path
) -> None:
    chance = random.Random(7)

    async def test() -> None:
        async with asyncio.timeout(2 * PATIENCE), accounts(homeserver, "Robin", "Ada") as (account, ada):
            rooms = await asyncio.gather(*(ada.room(account.id) for _ in range(20)))

            async def say(n: int) -> None:
                await asyncio.gather(*(ada.say(room, f"{n} in {room}") for room in rooms))

            await say(0)
            async with robin(account, tmp_path) as agent:
                await ada.listen(chance.randrange(2, 18))
                await agent.kill()
                await say(1)  # while the agent is down
                await agent.start()
                await ada.listen(chance.randrange(22, 38))
                homeserver.kill()
                homeserver.start()
                await say(2)
                await ada.listen(chance.randrange(42, 58))
                await agent.kill()
                await agent.start()
                await ada.listen(60)
                await ada.say(rooms[0], "the last")
                said = await ada.listen(61)
            for room in rooms:
                mine = [each.removeprefix(f"{room}: ") for each in said if each.startswith(room)]
                assert mine == [f"{n} in {room}" for n in range(3)] + ["the last"] * (room == rooms[0])

    asyncio.run(test())
