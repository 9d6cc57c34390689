"""The agent or the server dies in the middle of many conversations: no message is lost, and none is answered twice."""

import asyncio
import contextlib
import os
import random
import signal
import sys
from collections.abc import AsyncGenerator
from pathlib import Path

import pytest

from modules.platform.telegramio.conftest import Bot, Telegram

PARROT = """
import ravestate as rs
from ravestate.modules import rawio

parrot = rs.Module("parrot", requires=(rawio,))


@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx):
    await ctx.sleep(ctx.random.uniform(0.0, 0.02))
    ctx[rawio.output] = ctx.payload(rawio.input.changed)
"""


async def start(bot: Bot, folder: Path, module: str) -> asyncio.subprocess.Process:
    """Start an agent with a module in a process of its own."""
    environment = {
        **os.environ,
        "RAVESTATE_TELEGRAMIO_TOKEN": bot.token,
        "RAVESTATE_TELEGRAMIO_BASE_URL": f"{bot.telegram.root}/bot",
        "RAVESTATE_TELEGRAMIO_PATH": str(folder / "chats.sqlite"),
        "RAVESTATE_TELEGRAMIO_RATE": "1000",
    }
    return await asyncio.create_subprocess_exec(
        sys.executable, "-m", "ravestate", "run", "telegramio", module, env=environment
    )


@contextlib.asynccontextmanager
async def agent(bot: Bot, folder: Path) -> AsyncGenerator[asyncio.subprocess.Process]:
    """A parrot in a process of its own, killed at the end."""
    (folder / "parrot.py").write_text(PARROT)
    process = await start(bot, folder, str(folder / "parrot.py"))
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            process.kill()
        await process.wait()


def crowd(first: int, last: int) -> list[dict[str, object]]:
    return [{"chat": chat, "text": f"{n} of {chat}"} for n in range(first, last) for chat in range(1, 21)]


def whole(last: int) -> list[str]:
    return sorted(f"{chat}: {n} of {chat}" for n in range(last) for chat in range(1, 21))


def in_order(said: list[str]) -> bool:
    return all(
        [each for each in said if each.startswith(f"{chat}: ")] == [f"{chat}: {n} of {chat}" for n in range(6)]
        for chat in range(1, 21)
    )


@pytest.mark.parametrize("seed", range(2))
def test_the_agent_is_killed_and_nothing_is_lost_or_doubled(own_telegram: Telegram, tmp_path: Path, seed: int) -> None:
    bot = Bot(own_telegram)
    chance = random.Random(seed)

    async def test() -> None:
        async with asyncio.timeout(120):
            await bot.do("crowd", messages=crowd(0, 2))
            for n in (2, 4):
                async with agent(bot, tmp_path) as process:
                    await bot.said(chance.randrange(3, 30) + 40 * (n // 2 - 1))
                    writing = asyncio.create_task(bot.do("crowd", messages=crowd(n, n + 2)))
                    process.send_signal(signal.SIGKILL)
                    await process.wait()
                    await writing
            async with agent(bot, tmp_path):
                await bot.said(120)
                await bot.say(99, "the last")
                said = (await bot.said(121))[:120]
            assert sorted(said) == whole(6)
            assert in_order(said)

    asyncio.run(test())


def test_the_server_is_killed_and_nothing_is_lost_or_doubled(own_telegram: Telegram, tmp_path: Path) -> None:
    bot = Bot(own_telegram)
    chance = random.Random(7)

    async def test() -> None:
        async with asyncio.timeout(120):
            async with agent(bot, tmp_path):
                for n in (0, 2, 4):
                    await bot.do("crowd", messages=crowd(n, n + 2))
                    await bot.said(chance.randrange(3, 30) + 20 * n)
                    own_telegram.kill()
                    own_telegram.start()
                await bot.said(120)
                await bot.say(99, "the last")
                said = await bot.said(121)
            assert sorted(each for each in said if each != "99: the last") == whole(6)
            assert in_order([each for each in said if each != "99: the last"])

    asyncio.run(test())


def test_an_agent_that_ends_in_order_leaves_nothing_behind(own_telegram: Telegram, tmp_path: Path) -> None:
    bot = Bot(own_telegram)

    async def test() -> None:
        async with agent(bot, tmp_path) as process:
            await bot.do("crowd", messages=crowd(0, 2))
            await bot.said(10)
            process.send_signal(signal.SIGINT)
            assert await process.wait() == 0
        async with agent(bot, tmp_path):
            assert sorted(await bot.said(40)) == whole(2)

    asyncio.run(test())
