"""`Frames`: the agent's end of the connection with a bridge process."""

import asyncio
import socket

from modules.platform.ros.networks import PATIENCE, until
from ravestate.modules.platform.ros.frames import HEAD, PASSED, Frames, Kind


def test_an_exception_at_one_frame_does_not_lose_the_next_frames() -> None:
    async def main() -> None:
        got: list[int] = []
        complaints: list[str] = []

        def take(kind: Kind, channel: int, number: int, body: memoryview) -> None:
            got.append(number)
            if number == 1:
                raise ValueError("a rule's fault")

        loop = asyncio.get_running_loop()
        loop.set_exception_handler(lambda _, told: complaints.append(f"{told['message']}: {told['exception']}"))
        ours, theirs = socket.socketpair()
        one, other = Frames(ours, take, lambda: None), Frames(theirs, take, lambda: None)
        for number in range(4):
            other.send(Kind.MESSAGE, 1, number, b"text")
        async with asyncio.timeout(PATIENCE):
            await until(lambda: len(got) >= 4)
        assert got == [0, 1, 2, 3]
        assert complaints == ["a frame (MESSAGE) failed: a rule's fault"]
        one.close()
        other.close()

    asyncio.run(main())


def test_data_that_is_not_a_frame_ends_the_connection() -> None:
    async def main() -> None:
        lost: list[bool] = []
        ours, theirs = socket.socketpair()
        Frames(ours, lambda *_: None, lambda: lost.append(True))
        theirs.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        async with asyncio.timeout(PATIENCE):
            await until(lambda: lost)
        assert theirs.recv(1) == b""
        theirs.close()

    asyncio.run(main())


def test_a_socket_from_the_bridge_is_not_inherited_by_child_processes() -> None:
    async def main() -> None:
        got: list[bool] = []
        ours, theirs = socket.socketpair()

        def take(kind: Kind, channel: int, number: int, body: memoryview) -> None:
            with frames.passed() as sock:
                got.append(sock.get_inheritable())

        frames = Frames(ours, take, lambda: None)
        socket.send_fds(theirs, [HEAD.pack(Kind.PUBLISHER, PASSED, 0, 1, 0)], [theirs.fileno()])
        async with asyncio.timeout(PATIENCE):
            await until(lambda: got)
        assert got == [False]
        frames.close()
        theirs.close()

    asyncio.run(main())
