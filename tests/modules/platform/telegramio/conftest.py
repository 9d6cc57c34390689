"""Fixtures of the Telegram tests: a stand-in for the Bot API server in a separate process, and its bots."""

import itertools
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

SERVER = Path(__file__).with_name("api_server.py")
_numbers = itertools.count(1000)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Telegram:
    """A Bot API server that can be killed and started again."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self.root = f"http://127.0.0.1:{self.port}"
        self._file = folder / "telegram.sqlite"
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        command = [sys.executable, str(SERVER), str(self.port), str(self._file)]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert self._process.stdout is not None
        assert self._process.stdout.readline() == b"ready\n", "the server has ended"

    def kill(self) -> None:
        assert self._process is not None
        self._process.kill()
        self._process.communicate()


class Bot:
    """A bot on a server. It also acts as all users of the bot."""

    def __init__(self, telegram: Telegram) -> None:
        self.telegram = telegram
        self.token = f"{next(_numbers)}:{os.urandom(8).hex()}"

    @property
    def settings(self) -> dict[str, Any]:
        return {"token": self.token, "base_url": f"{self.telegram.root}/bot", "rate": 1000.0}

    async def do(self, order: str, **arguments: Any) -> Any:
        async with httpx.AsyncClient(timeout=120.0, verify=False, trust_env=False) as client:
            answer = await client.post(f"{self.telegram.root}/control/{self.token}/{order}", json=arguments)
            return answer.raise_for_status().json()

    async def say(self, chat: int, text: str | None = None, **fields: Any) -> Any:
        return await self.do("say", chat=chat, text=text, **fields)

    async def said(self, count: int) -> list[str]:
        """Wait until the bot has sent `count` messages; return them as "chat: text"."""
        return [f"{m['chat']['id']}: {m.get('text', m.get('caption'))}" for m in await self.do("said", count=count)]


@pytest.fixture(scope="session")
def telegram(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Telegram]:
    server = Telegram(tmp_path_factory.mktemp("telegram"))
    server.start()
    yield server
    server.kill()


@pytest.fixture
def own_telegram(tmp_path: Path) -> Iterator[Telegram]:
    """A server that only one test uses, so the test can kill it."""
    server = Telegram(tmp_path)
    server.start()
    yield server
    server.kill()


@pytest.fixture
def bot(telegram: Telegram) -> Bot:
    return Bot(telegram)
