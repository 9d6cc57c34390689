"""The agent's end of the pipe to a bridge (a process that runs a ROS library).

The pipe is a socket that carries *frames*: units of data, each with a head and a body. (They are not the coordinate
frames of ROS.) ``children/pipe.py`` is the other end, and describes the frames.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import mmap
import os
import socket
import struct
from collections import deque
from collections.abc import Callable
from enum import IntEnum
from typing import Any

from .outbox import Outbox

HEAD = struct.Struct("<BBxxIII")
SHARED = 1
"""The flag of a frame whose body is in shared memory."""
PASSED = 2
"""The flag of a frame that comes with a socket; see `Frames.passed`."""
LARGE = 1 << 16
"""Over a Unix socket on Linux, a body of at least this many bytes travels in shared memory. Over TCP, it does not."""
BLOCK = 1 << 16
"""Read at most this many bytes in one call. To allocate a larger buffer would take longer than to read a short message."""
TURN = 64
"""After handling this many frames, give other tasks a turn."""


class Kind(IntEnum):
    """The kind of a frame."""

    OPEN = 1
    BIND = 2
    UNBIND = 3
    MESSAGE = 4
    ACK = 5
    CALL = 6
    ANSWER = 7
    FAULT = 8
    FEEDBACK = 9
    CANCEL = 10
    ASK = 11
    TOLD = 12
    NOTE = 13
    READY = 14
    CLOSE = 15
    SUBSCRIBER = 16
    PUBLISHER = 17
    HANGUP = 18


KINDS = {int(kind): kind for kind in Kind}

Handle = Callable[[Kind, int, int, memoryview], None]


class Frames:
    """A socket that carries frames, on a running loop.

    Args:
        sock: The connected socket; this object closes it.
        handle: A function to call on the loop with the kind, channel, number and body of each frame that comes.
        lost: A function to call once on the loop when the other end has closed the socket or sends other data, or the
            socket fails.
    """

    def __init__(self, sock: socket.socket, handle: Handle, lost: Callable[[], None]) -> None:
        self._sock = sock
        self._local = sock.family == socket.AF_UNIX
        self._loop = asyncio.get_running_loop()
        self._handle = handle
        self._lost = lost
        self._rest = bytearray()
        self._fds: deque[int] = deque()
        self._out = Outbox(sock, self._end)
        self._closed = False
        self._loop.add_reader(sock, self._readable)

    def send(self, kind: Kind, channel: int = 0, number: int = 0, body: bytes | memoryview = b"") -> None:
        """Send a frame, now or as soon as the other end reads."""
        if self._closed:
            return
        if len(body) >= LARGE and self._local and hasattr(os, "memfd_create"):
            fd = os.memfd_create("ravestate")
            rest = memoryview(body).cast("B")
            while rest:
                rest = rest[os.write(fd, rest) :]
            self._out.put(HEAD.pack(kind, SHARED, channel, number, len(body)), fd)
        else:
            self._out.put(HEAD.pack(kind, 0, channel, number, len(body)) + bytes(body))

    def tell(self, kind: Kind, value: Any, channel: int = 0, number: int = 0) -> None:
        """Send a frame whose body is a value as JSON."""
        self.send(kind, channel, number, json.dumps(value).encode())

    async def flush(self) -> None:
        """Wait until all frames have left, or the socket is closed."""
        await self._out.flush()

    def passed(self) -> socket.socket:
        """Return the socket that came with a frame. Call this in `handle`."""
        return socket.socket(fileno=self._fds.popleft())

    def close(self) -> None:
        """Close the socket."""
        if self._closed:
            return
        self._closed = True
        self._loop.remove_reader(self._sock)
        self._out.close()
        self._sock.close()
        for fd in self._fds:
            os.close(fd)
        self._fds.clear()

    def _readable(self) -> None:
        if self._closed:
            return
        try:
            if self._local:
                block, fds, _, _ = socket.recv_fds(self._sock, BLOCK, 16)
                for fd in fds:
                    os.set_inheritable(fd, False)  # else a child process would keep the connection open
                self._fds.extend(fds)
            else:
                block = self._sock.recv(BLOCK)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            block = b""
        if not block:
            self._end()
            return
        self._rest += block
        self._parse()

    def _parse(self) -> None:
        """Handle the complete frames. After `TURN` frames, read no more until the event loop has run other tasks."""
        rest, start = self._rest, 0
        for _ in range(TURN):
            if self._closed or len(rest) - start < HEAD.size:
                break
            kind, flags, channel, number, size = HEAD.unpack_from(rest, start)
            inline = 0 if flags & SHARED else size
            if len(rest) - start < HEAD.size + inline:
                break
            start += HEAD.size
            try:
                what = KINDS[kind]
                body = (
                    _mapped(self._fds.popleft(), size)
                    if flags & SHARED
                    else memoryview(bytes(memoryview(rest)[start : start + size]))
                )
            except LookupError:
                self._end()  # the other end does not use this protocol
                break
            start += inline
            try:
                self._handle(what, channel, number, body)
            except Exception as error:  # a fault in one frame must not affect the next frames
                self._loop.call_exception_handler({"message": f"a frame ({what.name}) failed", "exception": error})
        else:
            if not self._closed:
                self._loop.remove_reader(self._sock)
                self._loop.call_soon(self._go_on)
        del rest[:start]

    def _go_on(self) -> None:
        if not self._closed:
            self._loop.add_reader(self._sock, self._readable)
            self._parse()

    def _end(self) -> None:
        if not self._closed:
            self.close()
            with contextlib.suppress(RuntimeError):
                self._loop.call_soon(self._lost)


def _mapped(fd: int, size: int) -> memoryview:
    """Return a view of the bytes in shared memory. The memory is freed with the last view of it."""
    try:
        return memoryview(mmap.mmap(fd, size, access=mmap.ACCESS_READ))
    finally:
        os.close(fd)
