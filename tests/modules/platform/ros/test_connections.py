"""The channels of topics of ROS 1 whose publishers the agent reads itself."""

import asyncio
import socket
import struct
from collections.abc import Awaitable, Callable
from typing import Any

from modules.platform.ros.networks import PATIENCE, until
from ravestate.modules.platform.ros.channel import Channel
from ravestate.modules.platform.ros.connections import Connections, Publisher


def wire(*bodies: bytes) -> bytes:
    return b"".join(struct.pack("<I", len(body)) + body for body in bodies)


class Reader:
    """In the place of a node: it keeps what its channels take."""

    def __init__(self) -> None:
        self.taken: dict[int, list[bytes]] = {}
        self.acknowledged = 0

    def channel(self, number: int, **options: Any) -> Channel:
        self.taken[number] = []
        binding = {"name": "/topic", "type": "Text", "md5": "m", "latest": "pause" in options}
        return Channel(self, number, binding, "Text", **options)  # type: ignore[arg-type]  # it is used like a node

    def take(self, channel: Channel, body: memoryview) -> None:
        self.taken[channel.number].append(bytes(body))
        if channel.take is not None:
            channel.take(body)

    def acknowledge(self, channel: Channel) -> None:
        self.acknowledged += 1


def run(main: Callable[[Reader, Connections, socket.socket], Awaitable[None]]) -> None:
    """Run a test with a latching publisher's socket."""

    async def run() -> None:
        ours, theirs = socket.socketpair()
        connections = Connections(lambda _: None, print)
        async with asyncio.timeout(PATIENCE):
            connections.from_publisher(1, ours, Publisher("/topic", "Text", "m", latching=True), b"")
            await main(Reader(), connections, theirs)
        connections.close()
        theirs.close()

    asyncio.run(run())


def test_the_fault_of_one_channel_loses_no_message_of_another() -> None:
    async def main(reader: Reader, connections: Connections, theirs: socket.socket) -> None:
        def fault(body: Any) -> None:
            raise ValueError("a rule's fault")

        complaints: list[str] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, told: complaints.append(str(told["exception"])))
        connections.add(reader.channel(1, take=fault))
        connections.add(reader.channel(2))
        theirs.send(wire(b"one", b"two"))
        await until(lambda: len(reader.taken[2]) == 2)
        assert reader.taken == {1: [b"one", b"two"], 2: [b"one", b"two"]}
        assert complaints == ["a rule's fault"] * 2

    run(main)
