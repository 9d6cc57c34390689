"""A queue of bytes for a socket. The bytes leave immediately, or as soon as the other end reads."""

from __future__ import annotations

import asyncio
import os
import socket
from collections import deque
from collections.abc import Callable


class Outbox:
    """Sends pieces of data in order, without blocking the loop.

    Args:
        sock: The connected socket; its owner closes it.
        failed: A function to call when the other end is gone, and the socket accepts no more data.
        depth: The maximum number of pieces that wait behind the first one. A further piece replaces the oldest of
            them. By default, there is no limit.
    """

    def __init__(self, sock: socket.socket, failed: Callable[[], None], depth: int = 0) -> None:
        sock.setblocking(False)
        self._sock = sock
        self._failed = failed
        self._depth = depth
        self._loop = asyncio.get_running_loop()
        self._waiting: deque[tuple[memoryview, int | None]] = deque()
        self._sent = asyncio.Event()
        self._sent.set()

    def put(self, data: bytes, fd: int | None = None) -> None:
        """Send a piece of data, with a file descriptor if one is given. The outbox closes the descriptor."""
        if self._depth and len(self._waiting) > self._depth:
            del self._waiting[1]  # not the first piece, because part of it may have left
        self._waiting.append((memoryview(data), fd))
        if self._sent.is_set():
            self._send()

    async def flush(self) -> None:
        """Wait until all pieces have left, or the outbox is closed."""
        await self._sent.wait()

    def close(self) -> None:
        """Drop the waiting pieces."""
        self._loop.remove_writer(self._sock)
        for _, fd in self._waiting:
            if fd is not None:
                os.close(fd)
        self._waiting.clear()
        self._sent.set()

    def _send(self) -> None:
        waiting = self._waiting
        while waiting:
            data, fd = waiting[0]
            try:
                sent = self._sock.send(data) if fd is None else socket.send_fds(self._sock, [data], [fd])
            except (BlockingIOError, InterruptedError):
                self._sent.clear()
                self._loop.add_writer(self._sock, self._send)
                return
            except OSError:
                self._failed()
                return
            if fd is not None:
                os.close(fd)
            if sent < len(data):
                waiting[0] = data[sent:], None
            else:
                waiting.popleft()
        if not self._sent.is_set():
            self._loop.remove_writer(self._sock)
            self._sent.set()
