"""Connections that the agent itself has with publishers and subscribers of ROS 1."""

import asyncio
import socket
import statistics
import struct
import time
from collections.abc import Awaitable, Callable

import pytest

from modules.platform.ros.networks import PATIENCE, until
from ravestate.modules.platform.ros.connection import LONGEST, TURN, FromPublisher, ToSubscriber

Taken = list[tuple[bytes, bool]]


def wire(*bodies: bytes) -> bytes:
    return b"".join(struct.pack("<I", len(body)) + body for body in bodies)


def receive(main: Callable[[socket.socket, Taken, list[str]], Awaitable[None]], *, first: bytes = b"") -> None:
    """Run a test of a connection from a publisher.

    The test gets the publisher's socket, a list of the messages that have arrived, and a list of other events.
    """

    async def run() -> None:
        ours, theirs = socket.socketpair()
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        theirs.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 20)
        theirs.setblocking(False)
        taken: Taken = []
        events: list[str] = []

        def take(body: memoryview, newest: bool) -> None:
            taken.append((bytes(body), newest))

        connection = FromPublisher(ours, take, lambda: events.append("lost"), events.append, first)
        async with asyncio.timeout(PATIENCE):
            await main(theirs, taken, events)
        connection.close()
        theirs.close()

    asyncio.run(run())


def send(main: Callable[[ToSubscriber, socket.socket, list[bool]], Awaitable[None]]) -> None:
    """Run a test of a connection to a subscriber.

    The test gets the connection, the subscriber's socket, and a list that is empty until the connection is lost.
    """

    async def run() -> None:
        ours, theirs = socket.socketpair()
        theirs.setblocking(False)
        lost: list[bool] = []
        connection = ToSubscriber(ours, lambda: lost.append(True), 3)
        async with asyncio.timeout(PATIENCE):
            await main(connection, theirs, lost)
        connection.close()
        theirs.close()

    asyncio.run(run())


@pytest.mark.parametrize("piece", [1, 3, 7, 1 << 20])
def test_messages_are_joined_from_pieces_of_any_size(piece: int) -> None:
    bodies = [b"one", b"", b"x" * 100, b"last"]
    data = wire(*bodies)

    async def main() -> None:
        ours, theirs = socket.socketpair()
        taken: list[bytes] = []
        connection = FromPublisher(ours, lambda body, _: taken.append(bytes(body)), lambda: None, print, data[:2])
        for start in range(2, len(data), piece):
            theirs.send(data[start : start + piece])
            connection.read()  # called as the event loop would call it
        assert taken == bodies
        connection.close()
        theirs.close()

    asyncio.run(main())


def test_only_the_last_of_several_messages_that_have_arrived_is_marked_as_the_newest() -> None:
    bodies = [bytes([n]) * 8000 for n in range(20)]  # each is longer than one read

    async def main(theirs: socket.socket, taken: Taken, events: list[str]) -> None:
        assert theirs.send(wire(*bodies) + wire(b"half")[:6]) > 20 * 8000
        await until(lambda: taken)
        assert taken == [*((body, False) for body in bodies[:-1]), (bodies[-1], True)]

    receive(main)


def test_a_message_that_needs_several_turns_of_the_loop_arrives() -> None:
    async def main(theirs: socket.socket, taken: Taken, events: list[str]) -> None:
        await asyncio.get_running_loop().sock_sendall(theirs, wire(b"x" * (TURN + 300_000), b"next"))
        await until(lambda: len(taken) == 2)
        assert [len(body) for body, _ in taken] == [TURN + 300_000, 4]

    receive(main)


def test_the_time_of_a_read_does_not_grow_with_the_message() -> None:
    async def main() -> None:
        ours, theirs = socket.socketpair()
        taken: list[int] = []
        connection = FromPublisher(ours, lambda body, _: taken.append(len(body)), lambda: None, print)
        size, piece = 16 << 20, 1 << 14
        theirs.send(struct.pack("<I", size))
        times: list[float] = []
        for _ in range(size // piece):
            theirs.send(bytes(piece))
            start = time.thread_time()
            connection.read()
            times.append(time.thread_time() - start)
        assert taken == [size]
        # If each read copied the message so far, the last reads would take 200 times as long as the first.
        assert statistics.median(times[-100:]) < 20 * statistics.median(times[:100])
        connection.close()
        theirs.close()

    asyncio.run(main())


def test_an_impossible_length_of_a_message_ends_the_connection() -> None:
    async def main(theirs: socket.socket, taken: Taken, events: list[str]) -> None:
        theirs.send(wire(b"good") + struct.pack("<I", LONGEST + 1) + b"x")
        await until(lambda: len(events) == 2)
        assert "announces a message of 268435457 bytes" in events[0] and events[1] == "lost"
        assert taken == [(b"good", True)]

    receive(main)


def test_the_loss_of_a_publisher_is_reported_once() -> None:
    async def main(theirs: socket.socket, taken: Taken, events: list[str]) -> None:
        theirs.send(wire(b"last words"))
        theirs.close()
        await until(lambda: events)
        assert (taken, events) == ([(b"last words", True)], ["lost"])

    receive(main)


def test_for_a_subscriber_that_does_not_read_only_the_newest_messages_are_kept() -> None:
    async def main(connection: ToSubscriber, theirs: socket.socket, lost: list[bool]) -> None:
        bodies = [bytes([n]) * 1_000_000 for n in range(10)]
        for body in bodies:
            connection.send(body)
        wanted = wire(bodies[0], *bodies[-3:])  # the first message was already being sent
        data = b""
        while len(data) < len(wanted):
            data += await asyncio.get_running_loop().sock_recv(theirs, 1 << 20)
        assert data == wanted
        await connection.flush()
        connection.send(b"again")
        assert await asyncio.get_running_loop().sock_recv(theirs, 100) == wire(b"again")

    send(main)


def test_data_from_a_subscriber_is_ignored() -> None:
    async def main(connection: ToSubscriber, theirs: socket.socket, lost: list[bool]) -> None:
        await asyncio.get_running_loop().sock_sendall(theirs, struct.pack("<I", 0xFFFFFFF0) + bytes(1 << 20))
        connection.send(b"one")
        assert await asyncio.get_running_loop().sock_recv(theirs, 100) == wire(b"one")
        held = [value for value in vars(connection).values() if isinstance(value, bytes | bytearray)]
        assert not held and not lost
        theirs.close()
        await until(lambda: lost)
        connection.send(b"too late")
        await connection.flush()
        assert lost == [True]

    send(main)
