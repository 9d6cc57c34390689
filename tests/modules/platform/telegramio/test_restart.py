"""The agent and the server are killed during 200 conversations. Each message still gets exactly one answer."""

import asyncio
import random
import signal
from collections import defaultdict
from pathlib import Path

from modules.platform.chats.process import AgentProcess
from modules.platform.telegramio.conftest import Bot, Telegram

CHATS = range(1, 201)
PARROT = """
import ravestate as rs
from ravestate.modules import rawio

parrot = rs.Module("parrot", requires=(rawio,))


@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx):
    await ctx.sleep(ctx.random.uniform(0.0, 0.02))
    ctx[rawio.output] = ctx.payload(rawio.input.changed)
"""


def robin(bot: Bot, folder: Path, module: str) -> AgentProcess:
    """Return an agent with a module, in a separate process."""
    address, path = f"{bot.telegram.root}/bot", folder / "chats.sqlite"
    return AgentProcess("telegramio", module, token=bot.token, base_url=address, path=path, rate=1000)


def parrot(bot: Bot, folder: Path) -> AgentProcess:
    file = folder / "parrot.py"
    file.write_text(PARROT)
    return robin(bot, folder, str(file))


async def crowd(bot: Bot, n: int) -> None:
    """Let the user of each chat say something."""
    await bot.do("crowd", messages=[{"chat": chat, "text": f"{n} of {chat}"} for chat in CHATS])


def by_chat(said: list[str]) -> dict[int, list[str]]:
    found: dict[int, list[str]] = defaultdict(list)
    for each in said:
        chat, _, text = each.partition(": ")
        found[int(chat)].append(text)
    return found


def test_no_message_is_lost_or_answered_twice_when_agent_and_server_are_killed(
    own_telegram: Telegram, tmp_path: Path
) -> None:
    bot = Bot(own_telegram)
    chance = random.Random(7)

    async def test() -> None:
        async with asyncio.timeout(120), parrot(bot, tmp_path) as agent:
            await crowd(bot, 0)
            await bot.said(chance.randrange(20, 180))
            await agent.kill()
            await crowd(bot, 1)  # while the agent is down
            await agent.start()
            await bot.said(chance.randrange(220, 280))
            own_telegram.kill()
            own_telegram.start()
            await bot.said(chance.randrange(300, 380))
            await agent.kill()
            own_telegram.kill()
            own_telegram.start()
            await agent.start()
            await bot.said(400)
            await bot.say(999, "the last")
            said = await bot.said(401)
        assert by_chat(said) == {999: ["the last"]} | {chat: [f"{n} of {chat}" for n in range(2)] for chat in CHATS}

    asyncio.run(test())


def test_after_a_clean_end_and_a_restart_each_message_is_answered_once(own_telegram: Telegram, tmp_path: Path) -> None:
    bot = Bot(own_telegram)

    async def test() -> None:
        async with asyncio.timeout(120):
            async with parrot(bot, tmp_path) as agent:
                await crowd(bot, 0)
                await bot.said(10)
                assert await agent.end(signal.SIGINT) == 0
            async with parrot(bot, tmp_path):
                assert by_chat(await bot.said(200)) == {chat: [f"0 of {chat}"] for chat in CHATS}

    asyncio.run(test())
