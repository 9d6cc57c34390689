"""A connection with one subscriber of ROS 1. Its messages leave the agent without a way through the bridge."""

from __future__ import annotations

import asyncio
import socket
import struct
from collections.abc import Callable

from .outbox import Outbox

LENGTH = struct.Struct("<I")


class Connection:
    """A connection that the bridge has made with a subscriber, and has passed to the agent.

    Args:
        sock: The connected socket; this object closes it.
        depth: The maximum number of messages that wait for the subscriber. A further one replaces the oldest.
        lost: Called once on the loop when the subscriber has closed the connection.
    """

    def __init__(self, sock: socket.socket, depth: int, lost: Callable[[], None]) -> None:
        self._sock = sock
        self._lost = lost
        self._loop = asyncio.get_running_loop()
        self._out = Outbox(sock, self._end, depth)
        self._closed = False
        self._loop.add_reader(sock, self._readable)

    def send(self, body: bytes | memoryview) -> None:
        """Send a message, now or as soon as the subscriber reads."""
        if not self._closed:
            self._out.put(b"".join((LENGTH.pack(len(body)), body)))

    async def flush(self) -> None:
        """Wait until all messages have left."""
        await self._out.flush()

    def close(self) -> None:
        """Close the connection."""
        if not self._closed:
            self._closed = True
            self._loop.remove_reader(self._sock)
            self._out.close()
            self._sock.close()

    def _readable(self) -> None:
        """Notice the end of the connection: a subscriber sends nothing."""
        try:
            ended = not self._sock.recv(1 << 12)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            ended = True
        if ended:
            self._end()

    def _end(self) -> None:
        if not self._closed:
            self.close()
            self._lost()
