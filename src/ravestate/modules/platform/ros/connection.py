"""Connections of ROS 1 between the agent and another node.

Their messages do not pass through the bridge (the process that runs rospy for the agent).
"""

from __future__ import annotations

import abc
import asyncio
import socket
import struct
from collections.abc import Callable

from .outbox import Outbox

LENGTH = struct.Struct("<I")
BLOCK = 1 << 12
"""Read this many bytes in one call, unless the rest of a message is longer. A larger buffer takes longer to allocate."""
TURN = 1 << 20
"""After reading this many bytes, let the event loop run other tasks."""
MESSAGES = 1000
"""After reading this many messages, let the event loop run other tasks."""
LONGEST = 1 << 28
"""The maximum length of a message in bytes. A greater length means that the data are not a message."""


class _Connection(abc.ABC):
    """A TCP connection that the bridge has made and then passed to the agent.

    Args:
        sock: The connected socket; this object closes it.
        lost: A function to call once on the loop when the connection has ended, unless `close` has ended it.
    """

    def __init__(self, sock: socket.socket, lost: Callable[[], None]) -> None:
        sock.setblocking(False)
        self._sock = sock
        self._lost = lost
        self._closed = False
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(sock, self.read)

    @abc.abstractmethod
    def read(self) -> None:
        """Read the data that have come."""

    def close(self) -> None:
        """Close the connection."""
        if not self._closed:
            self._closed = True
            self._loop.remove_reader(self._sock)
            self._sock.close()

    def _receive(self, size: int) -> bytes | None:
        """Return at most `size` bytes: ``b""`` if the connection has ended, and None if no data have come."""
        try:
            return self._sock.recv(size)
        except (BlockingIOError, InterruptedError):
            return None
        except OSError:
            return b""

    def _end(self) -> None:
        if not self._closed:
            self.close()
            self._lost()


class ToSubscriber(_Connection):
    """A connection with a subscriber. The agent ignores all data from the subscriber.

    Args:
        sock: The connected socket; this object closes it.
        lost: A function to call once on the loop when the subscriber has closed the connection.
        depth: The maximum number of messages that wait behind the one on its way. A further message replaces the oldest
            of them.
    """

    def __init__(self, sock: socket.socket, lost: Callable[[], None], depth: int) -> None:
        super().__init__(sock, lost)
        self._out = Outbox(sock, self._end, depth)

    def send(self, body: bytes | memoryview) -> None:
        """Send a message, now or as soon as the subscriber reads."""
        if not self._closed:
            self._out.put(b"".join((LENGTH.pack(len(body)), body)))

    async def flush(self) -> None:
        """Wait until all messages have left."""
        await self._out.flush()

    def read(self) -> None:
        """Find out whether the subscriber has closed the connection."""
        if self._receive(BLOCK) == b"":
            self._end()

    def close(self) -> None:
        """Close the connection."""
        if not self._closed:
            self._out.close()
            super().close()


class FromPublisher(_Connection):
    """A connection with a publisher. Before each message, the publisher sends the message's length.

    Args:
        sock: The connected socket; this object closes it.
        take: A function to call on the loop with each message, and with True if the message is the newest one so far.
        lost: A function to call once on the loop when the publisher closes the connection, or sends invalid data.
        warn: A function to call with a sentence about data that are not a message.
        first: The bytes that the bridge has already read.
    """

    def __init__(
        self,
        sock: socket.socket,
        take: Callable[[memoryview, bool], None],
        lost: Callable[[], None],
        warn: Callable[[str], None],
        first: bytes = b"",
    ) -> None:
        super().__init__(sock, lost)
        self._take = take
        self._warn = warn
        self._rest = bytearray(first)
        self._lacks = BLOCK

    def read(self) -> None:
        """Read data until a limit (`TURN`, `MESSAGES`), and pass on the complete messages. Only the last one counts as newest."""
        bodies = list[memoryview]()
        goes_on, room = self._split(bodies), TURN
        while goes_on and room > 0 and len(bodies) < MESSAGES:
            wanted = self._lacks
            block = self._receive(wanted)
            if block is None:
                break
            self._rest += block
            room -= len(block)
            goes_on = block != b"" and self._split(bodies)
            if len(block) < wanted:
                break  # nothing more has come
        for body in bodies:
            if not self._closed:
                self._take(body, body is bodies[-1])
        if not goes_on:
            self._end()

    def _split(self, bodies: list[memoryview]) -> bool:
        """Move the complete messages into a list. Return whether the rest may be the beginning of a message."""
        rest, start = self._rest, 0
        self._lacks = BLOCK
        while len(rest) - start >= LENGTH.size:
            (size,) = LENGTH.unpack_from(rest, start)
            if size > LONGEST:
                self._warn(f"a publisher announces a message of {size} bytes, more than {LONGEST}: the connection ends")
                return False
            end = start + LENGTH.size + size
            if end > len(rest):
                self._lacks = min(max(BLOCK, end - len(rest)), TURN)
                break
            bodies.append(memoryview(bytes(memoryview(rest)[start + LENGTH.size : end])))
            start = end
        del rest[:start]
        return True
