"""A WebSocket with manners: what is read and written on it ends together, and faults are not lost."""

import asyncio
from typing import Any

import pytest

from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules.platform.webio.channel import Channel
from ravestate.modules.platform.webio.protocol import CLOSING_CODES, ProtocolError


class Socket:
    """One end of a WebSocket, which keeps what is done with it."""

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
def test_whatever_is_wrong_is_told_and_closes_it(code: str) -> None:
    socket = Socket()

    async def serve() -> None:
        raise ProtocolError(code, "no")

    asyncio.run(channel_on(socket).carry(serve))
    closed = (CLOSING_CODES.get(code, 4400), code)
    assert socket.done == ["accept", f'{{"type":"error","code":"{code}","text":"no"}}', closed]


@in_virtual_time
async def test_when_either_ends_the_other_does_and_its_fault_is_not_lost() -> None:
    ended: list[str] = []

    async def for_ever() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("for ever")

    async def fails() -> None:
        await past(1.0)
        raise ProtocolError("behind", "too slow")

    channel = channel_on(Socket())
    await channel.both(for_ever(), past(1.0))
    with pytest.raises(ProtocolError, match="too slow"):
        await channel.both(fails(), for_ever())
    assert ended == ["for ever", "for ever"]


@in_virtual_time
async def test_replies_are_sent_in_their_order_when_there_is_time() -> None:
    socket = Socket()
    channel = channel_on(socket)
    channel.reply("one")
    channel.reply("two")
    assert channel.woken.is_set()
    assert socket.done == []
    await channel.send_replies()
    assert socket.done == ["one", "two"]
