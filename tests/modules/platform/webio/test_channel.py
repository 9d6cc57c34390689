"""A channel sends each protocol error before it closes the WebSocket, and sends replies in order."""

import asyncio
from typing import Any

import pytest

from modules.platform.webio.visit import in_virtual_time
from ravestate.modules.platform.webio.channel import LONGEST, Channel
from ravestate.modules.platform.webio.fields import CLOSING_CODES, ProtocolError


class Socket:
    """A stand-in for a WebSocket, which records all calls."""

    def __init__(self) -> None:
        self.done: list[Any] = []
        self.frames: list[str | bytes] = []
        """The client's frames, for `receive`."""

    async def accept(self) -> None:
        self.done.append("accept")

    async def receive(self) -> dict[str, Any]:
        frame = self.frames.pop(0)
        return {"type": "websocket.receive", "text" if isinstance(frame, str) else "bytes": frame}

    async def send_text(self, text: str) -> None:
        self.done.append(text)

    async def close(self, code: int, reason: str) -> None:
        self.done.append((code, reason))


def channel_on(socket: Socket) -> Channel:
    return Channel(socket, replies=2)  # type: ignore[arg-type]  # it has the methods that a channel uses


@pytest.mark.parametrize("code", [*CLOSING_CODES, "too-long", "empty", "a code that does not exist yet"])
def test_a_protocol_error_is_sent_before_the_websocket_is_closed(code: str) -> None:
    socket = Socket()

    async def serve() -> None:
        raise ProtocolError(code, "no")

    asyncio.run(channel_on(socket).carry(serve))
    closed = (CLOSING_CODES.get(code, 4400), code)
    assert socket.done == ["accept", f'{{"type":"error","code":"{code}","text":"no"}}', closed]


@in_virtual_time
async def test_replies_wait_until_they_are_sent_in_order() -> None:
    socket = Socket()
    channel = channel_on(socket)
    channel.reply("one")
    channel.reply("two")
    assert channel.woken.is_set()
    assert socket.done == []
    await channel.send_replies()
    assert socket.done == ["one", "two"]


@pytest.mark.parametrize("frame", ["a" * LONGEST, "é" * (LONGEST // 2), bytes(LONGEST)], ids=["ascii", "é", "bytes"])
def test_a_frame_is_too_large_if_it_has_more_bytes_than_the_limit(frame: str | bytes) -> None:
    socket = Socket()
    socket.frames = [frame, frame + frame[:1]]
    channel = channel_on(socket)
    assert asyncio.run(channel.receive()) == frame
    with pytest.raises(ProtocolError, match="a frame has at most 131,072 bytes, not 131,07") as caught:
        asyncio.run(channel.receive())
    assert caught.value.code == "too-large"
