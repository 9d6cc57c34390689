"""A connection of ROS 1 between the agent and another node. Its messages pass without a way through the bridge."""

from __future__ import annotations

import asyncio
import socket
import struct
from collections.abc import Callable

from .outbox import Outbox

LENGTH = struct.Struct("<I")
BLOCK = 1 << 12
"""The number of bytes to read at once, or more if a message lacks more. A block of short messages is one turn's work."""


class Connection:
    """A TCP connection that the bridge has made, and has passed to the agent: messages, each after its length.

    Args:
        sock: The connected socket; this object closes it.
        take: Called on the loop with each message that comes, and whether it is the newest that has been read.
        lost: Called once on the loop when the other node has closed the connection.
        depth: The maximum number of messages that wait for the other node. A further one replaces the oldest.
    """

    def __init__(
        self,
        sock: socket.socket,
        take: Callable[[memoryview, bool], None],
        lost: Callable[[], None],
        depth: int = 0,
    ) -> None:
        self._sock = sock
        self._take = take
        self._lost = lost
        self._loop = asyncio.get_running_loop()
        self._out = Outbox(sock, self._end, depth)
        self._rest = b""
        self._lacks = BLOCK
        self._closed = False
        self._loop.add_reader(sock, self._readable)

    def send(self, body: bytes | memoryview) -> None:
        """Send a message, now or as soon as the other node reads."""
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

    def receive(self, block: bytes) -> None:
        """Take the messages that are complete with these bytes."""
        data = self._rest + block if self._rest else block
        view, start, bodies, lacks = memoryview(data), 0, list[memoryview](), 0
        while len(data) - start >= LENGTH.size:
            (size,) = LENGTH.unpack_from(data, start)
            end = start + LENGTH.size + size
            lacks = end - len(data)
            if lacks > 0:
                break
            bodies.append(view[start + LENGTH.size : end])
            start = end
        self._rest = data[start:]
        self._lacks = max(BLOCK, lacks)
        for body in bodies:
            if self._closed:
                return
            try:
                self._take(body, body is bodies[-1])
            except Exception as error:  # the fault of one message must not lose those that follow
                self._loop.call_exception_handler({"message": "a message failed", "exception": error})

    def _readable(self) -> None:
        try:
            block = self._sock.recv(self._lacks)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            block = b""
        if block:
            self.receive(block)
        else:
            self._end()

    def _end(self) -> None:
        if not self._closed:
            self.close()
            self._lost()
