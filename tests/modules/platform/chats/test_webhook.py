"""The webhook: it accepts requests with the secret, and acknowledges them after storing their messages."""

import asyncio
import contextlib
import socket
import sqlite3
from typing import Any

import httpx
import pytest

from modules.platform.telegramio.conftest import free_port
from ravestate.errors import PlatformError
from ravestate.modules.platform.chats import webhook


def test_the_webhook_accepts_only_small_json_requests_with_the_secret() -> None:
    taken: list[Any] = []
    full: list[bool] = []

    def take(data: Any) -> None:
        if full:
            raise sqlite3.OperationalError("database or disk is full")
        taken.append(data)

    async def test() -> None:
        port, ready = free_port(), asyncio.Event()

        async def announce() -> None:
            ready.set()

        address = ("127.0.0.1", port)
        task = asyncio.create_task(
            webhook.listen("https://bot.example/in", address, "x-secret", "s3cret", take, announce)
        )
        await ready.wait()
        url = f"http://127.0.0.1:{port}/in"
        async with httpx.AsyncClient(trust_env=False) as client:
            right = {"x-secret": "s3cret"}

            async def status(headers: dict[str, str], **body: Any) -> int:
                return (await client.post(url, headers=headers, **body)).status_code

            assert await status(right, json={"update_id": 1}) == 200
            assert await status({}, json={"update_id": 2}) == 403
            assert await status({"x-secret": "wrong"}, json={"update_id": 3}) == 403
            assert await status(right, content=b"no json") == 400
            full.append(True)
            assert await status(right, json={"update_id": 4}) == 503
            full.clear()
            assert await status(right, content=b"x" * (webhook.LARGEST + 1)) == 413
            assert (await client.get(url)).status_code == 405
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    asyncio.run(test())
    assert taken == [{"update_id": 1}]


def test_the_message_for_a_port_in_use_names_the_port() -> None:
    async def never() -> None:
        raise AssertionError

    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(PlatformError, match=f"cannot listen on 127.0.0.1, port {port}"):
            asyncio.run(webhook.listen("https://bot.example/", ("127.0.0.1", port), "x", "y", print, never))


@pytest.mark.parametrize("host", ["::1", "[::1]"])
def test_the_webhook_listens_on_an_address_of_ipv6(host: str) -> None:
    class Listening(Exception):
        pass

    async def announce() -> None:
        raise Listening

    with pytest.raises(Listening):
        asyncio.run(webhook.listen("https://bot.example/", (host, 0), "x", "y", print, announce))
