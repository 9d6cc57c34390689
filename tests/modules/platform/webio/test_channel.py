"""A channel: its reading and its writing end together, and no fault is lost."""

import asyncio
from typing import Any

import pytest

from modules.platform.webio.visit import in_virtual_time
from ravestate.modules.platform.webio.channel import Channel
from ravestate.modules.platform.webio.fields import CLOSING_CODES, ProtocolError


class Socket:
    """One end of a WebSocket, which records all calls."""

    def __init__(self) -> None:
        self.done: list[Any] = []

    async def accept(self) -> None:
        self.done.append("accept")

    async def send_text(self, text: str) -> None:
        self.done.append(text)

    async def close(self, code: int, reason: str) -> None:
        self.done.append((code, reason))


def channel_on(socket: Socket) -> Channel:
    return Channel(socket, replies=2)  # type: ignore[arg-type]  # it is used like one


@pytest.mark.parametrize("code", [*CLOSING_CODES, "too-long", "empty", "one that is added some day"])
def test_any_protocol_error_is_sent_and_closes_the_socket(code: str) -> None:
    socket = Socket()

    async def serve() -> None:
        raise ProtocolError(code, "no")

    asyncio.run(channel_on(socket).carry(serve))
    closed = (CLOSING_CODES.get(code, 4400), code)
    assert socket.done == ["accept", f'{{"type":"error","code":"{code}","text":"no"}}', closed]


@in_virtual_time
async def test_replies_wait_and_are_then_sent_in_order() -> None:
    socket = Socket()
    channel = channel_on(socket)
    channel.reply("one")
    channel.reply("two")
    assert channel.woken.is_set()
    assert socket.done == []
    await channel.send_replies()
    assert socket.done == ["one", "two"]
