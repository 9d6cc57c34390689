"""The agent's own connection with a node of ROS 1."""

import asyncio
import socket
import struct
from collections.abc import Awaitable, Callable

import pytest

from modules.platform.ros.networks import PATIENCE, until
from ravestate.modules.platform.ros.connection import Connection

Taken = list[tuple[bytes, bool]]


def wire(*bodies: bytes) -> bytes:
    return b"".join(struct.pack("<I", len(body)) + body for body in bodies)


def run(main: Callable[[Connection, socket.socket, Taken, list[bool]], Awaitable[None]], *, depth: int = 0) -> None:
    """Run a test with a connection, its other end, what has been taken, and whether it was lost."""

    async def run() -> None:
        ours, theirs = socket.socketpair()
        theirs.setblocking(False)
        taken: Taken = []
        lost: list[bool] = []

        def take(body: memoryview, newest: bool) -> None:
            taken.append((bytes(body), newest))
            if body == b"fault":
                raise ValueError("a rule's fault")

        connection = Connection(ours, take, lambda: lost.append(True), depth)
        async with asyncio.timeout(PATIENCE):
            await main(connection, theirs, taken, lost)
        connection.close()
        theirs.close()

    asyncio.run(run())


@pytest.mark.parametrize("piece", [1, 3, 7, 1 << 20])
def test_messages_arrive_whole_in_pieces_of_any_size(piece: int) -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        bodies = [b"one", b"", b"x" * 100, b"last"]
        data = wire(*bodies)
        for start in range(0, len(data), piece):
            connection.receive(data[start : start + piece])
        assert [body for body, _ in taken] == bodies

    run(main)


def test_the_newest_of_a_block_is_known() -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        theirs.send(wire(b"old", b"new") + wire(b"half")[:6])
        await until(lambda: taken)
        assert taken == [(b"old", False), (b"new", True)]

    run(main)


def test_a_message_longer_than_a_block_arrives() -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        await asyncio.get_running_loop().sock_sendall(theirs, wire(b"x" * 300_000, b"next"))
        await until(lambda: len(taken) == 2)
        assert [len(body) for body, _ in taken] == [300_000, 4]

    run(main)


def test_the_fault_of_one_message_loses_none_that_follow() -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        complaints: list[str] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, told: complaints.append(str(told["exception"])))
        connection.receive(wire(b"one", b"fault", b"three"))
        assert [body for body, _ in taken] == [b"one", b"fault", b"three"]
        assert complaints == ["a rule's fault"]

    run(main)


def test_while_the_other_node_does_not_read_the_newest_messages_wait() -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        bodies = [bytes([n]) * 1_000_000 for n in range(10)]
        for body in bodies:
            connection.send(body)
        wanted = wire(bodies[0], *bodies[-3:])  # the first was on its way
        data = b""
        while len(data) < len(wanted):
            data += await asyncio.get_running_loop().sock_recv(theirs, 1 << 20)
        assert data == wanted
        await connection.flush()
        connection.send(b"again")
        assert await asyncio.get_running_loop().sock_recv(theirs, 100) == wire(b"again")

    run(main, depth=3)


def test_the_end_of_the_other_node_is_noticed_once() -> None:
    async def main(connection: Connection, theirs: socket.socket, taken: Taken, lost: list[bool]) -> None:
        theirs.send(wire(b"last words"))
        theirs.close()
        await until(lambda: lost)
        connection.send(b"too late")
        await connection.flush()
        assert (taken, lost) == ([(b"last words", True)], [True])

    run(main)
