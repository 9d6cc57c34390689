"""Channels of ROS 1 topics, for which the agent itself has connections with other nodes."""

import asyncio
import json
import socket
import struct
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any

from modules.platform.ros.networks import PATIENCE, until
from ravestate.errors import PlatformError
from ravestate.modules.platform.ros.channel import Channel
from ravestate.modules.platform.ros.connections import Connections, Publisher
from ravestate.modules.platform.ros.definitions import Definitions
from ravestate.modules.platform.ros.frames import Handle, Kind
from ravestate.modules.platform.ros.naming import quality
from ravestate.modules.platform.ros.node import Node
from ravestate.modules.platform.ros.types import Types


def wire(*bodies: bytes) -> bytes:
    return b"".join(struct.pack("<I", len(body)) + body for body in bodies)


class Reader:
    """A stand-in for a node. It keeps the messages of its channels."""

    def __init__(self) -> None:
        self.taken: dict[int, list[bytes]] = {}
        self.acknowledged = 0

    def channel(self, number: int, **options: Any) -> Channel:
        self.taken[number] = []
        binding = {"name": "/topic", "type": "Text", "md5": "m", "latest": "pause" in options}
        return Channel(self, number, binding, "Text", **options)  # type: ignore[arg-type]  # it has the methods that a channel uses

    def take(self, channel: Channel, body: memoryview) -> None:
        self.taken[channel.number].append(bytes(body))
        if channel.take is not None:
            channel.take(body)

    def acknowledge(self, channel: Channel) -> None:
        self.acknowledged += 1


def run(
    main: Callable[[Reader, Connections, socket.socket], Awaitable[None]], patience: float | None = PATIENCE
) -> None:
    """Run a test with a `Reader`, its connections, and the socket of a publisher that latches its messages."""

    async def run() -> None:
        ours, theirs = socket.socketpair()
        connections = Connections(lambda _: None, print)
        async with asyncio.timeout(patience):
            connections.from_publisher(1, ours, Publisher("/topic", "Text", "m", latching=True), b"")
            await main(Reader(), connections, theirs)
        connections.close()
        theirs.close()

    asyncio.run(run())


def test_an_exception_in_one_channel_does_not_lose_a_message_of_another() -> None:
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


def test_a_new_channel_gets_only_the_newest_latched_message() -> None:
    async def main(reader: Reader, connections: Connections, theirs: socket.socket) -> None:
        connections.add(reader.channel(1))
        theirs.send(wire(b"old"))
        await until(lambda: reader.taken[1])
        ours, signal = socket.socketpair()
        loop = asyncio.get_running_loop()

        def add() -> None:
            loop.remove_reader(ours)
            connections.add(reader.channel(2))

        loop.add_reader(ours, add)  # this runs in the turn of the loop that also reads the new message
        signal.send(b"now")
        theirs.send(wire(b"new"))
        await until(lambda: reader.taken.get(2))
        connections.add(reader.channel(3))
        await until(lambda: reader.taken[3])
        assert reader.taken == {1: [b"old", b"new"], 2: [b"new"], 3: [b"new"]}
        ours.close()
        signal.close()

    run(main)


def test_the_rate_limit_of_a_channel_applies_to_direct_and_bridged_messages_together() -> None:
    async def main(reader: Reader, connections: Connections, theirs: socket.socket) -> None:
        channel = reader.channel(1, pause=1e6)
        bridge = partial(channel.offer, owed=True)
        taken = reader.taken[1]

        loop = asyncio.get_running_loop()
        time, passed = loop.time, 0.0
        loop.time = lambda: time() + passed

        async def end_of_pause() -> None:
            nonlocal passed
            ended = asyncio.Event()
            loop.call_later(1.1e6, ended.set)  # after the timer of the channel
            passed += 1.2e6
            await ended.wait()

        connections.add(channel)
        theirs.send(wire(b"direct 1"))
        await until(lambda: taken)
        bridge(memoryview(b"bridge 1"))
        assert taken == [b"direct 1"] and not reader.acknowledged
        await end_of_pause()
        assert taken == [b"direct 1", b"bridge 1"] and reader.acknowledged == 1
        bridge(memoryview(b"bridge 2"))
        theirs.send(wire(b"direct 2"))
        await until(lambda: bytes(channel.pending or b"") == b"direct 2")
        await end_of_pause()
        assert taken[2:] == [b"direct 2"] and reader.acknowledged == 2
        await end_of_pause()
        assert channel.timer is None and len(taken) == 3
        bridge(memoryview(b"bridge 3"))
        assert taken[3:] == [b"bridge 3"] and reader.acknowledged == 2
        await end_of_pause()
        assert reader.acknowledged == 3

    run(main, patience=None)  # the clock jumps


class Link:
    """A stand-in for the link to a bridge. It hands over sockets, and keeps the frames that the node sends."""

    def __init__(self, handle: Handle, ready: Callable[[], None]) -> None:
        self.failed: PlatformError | None = None
        self.restarts = 0
        self.pid: int | None = None
        self.handle, self.ready = handle, ready
        self.sent: list[tuple[Any, ...]] = []
        self.sockets: list[socket.socket] = []

    @property
    def frames(self) -> Any:
        return self

    def start(self) -> None: ...
    def kill(self) -> None: ...
    def tell(self, kind: Kind, value: Any, channel: int = 0) -> None: ...

    async def close(self) -> None: ...

    def send(self, kind: Kind, channel: int, number: int, body: bytes | memoryview = b"") -> None:
        self.sent.append((kind, channel, bytes(body)))

    def passed(self) -> socket.socket:
        return self.sockets.pop()

    def subscriber(self, number: int) -> bytes:
        """Hand over a connection with a new subscriber. Return the data that the subscriber gets immediately."""
        ours, theirs = socket.socketpair()
        self.sockets.append(ours)
        what = {"topic": "/topic", "depth": 5}
        self.handle(Kind.SUBSCRIBER, 0, number, memoryview(json.dumps(what).encode()))
        with theirs:
            theirs.setblocking(False)
            try:
                return theirs.recv(100)
            except BlockingIOError:
                return b""


def test_a_late_subscriber_gets_only_the_last_message_of_two_latching_channels() -> None:
    async def main() -> None:
        links: list[Link] = []

        def make_link(_: Any, handle: Handle, ready: Callable[[], None], __: Any) -> Link:
            links.append(Link(handle, ready))
            return links[-1]

        node = Node("ros1", Types(1, Definitions([])), make_link)
        qos = quality(None, depth=5, latch=True)
        one, two = (node.advertise("/topic", "std_msgs/Int8", latch=True, qos=qos) for _ in range(2))
        [link] = links
        two.publish(1)
        one.publish(2)
        last = wire(b"\2")
        assert [link.subscriber(1), link.subscriber(2)] == [last, last]
        one.close()  # the other channel still has the topic
        assert link.subscriber(3) == last
        link.sent.clear()
        link.ready()
        assert link.sent == [(Kind.MESSAGE, two.number, b"\2")]
        two.close()
        node.advertise("/topic", "std_msgs/Int8", latch=True, qos=qos)
        assert link.subscriber(4) == b""
        await node.close()

    asyncio.run(main())
