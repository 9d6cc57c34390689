"""The child's end of the pipe between an agent and its bridge (the process that runs a ROS library for the agent).

The bridge programs in this folder use this module.

A frame is a head (kind, flags, channel, number, size) and a body of `size` bytes. The channel is the number of one topic,
service or action of the agent. The frame's number is the number of a call, or of a connection. A body of at least `LARGE`
bytes travels in shared memory (on Linux): the sender copies it there once, and the pipe carries the file descriptor.
"""

# pyright: basic
from __future__ import annotations

import array
import json
import mmap
import os
import signal
import socket
import struct
import sys
import threading
import time

HEAD = struct.Struct("<BBxxIII")
SHARED = 1  # a flag: the body is in shared memory
PASSED = 2  # a flag: a socket comes with the frame
LARGE = 1 << 16
SEEKING = 0.7  # the server must appear in this part of a call's time-out, so that a fault reaches the agent in time

OPEN, BIND, UNBIND, MESSAGE, ACK, CALL, ANSWER, FAULT, FEEDBACK, CANCEL, ASK, TOLD, NOTE, READY, CLOSE = range(1, 16)
SUBSCRIBER, PUBLISHER, HANGUP = 16, 17, 18
"""The kinds of frames.

The agent sends OPEN, BIND, UNBIND, ACK, CANCEL, ASK, CLOSE and HANGUP. The bridge sends READY, FEEDBACK, TOLD, NOTE,
SUBSCRIBER and PUBLISHER. Both send MESSAGE, CALL, ANSWER and FAULT. SUBSCRIBER and PUBLISHER come with a socket, which
is the connection with another node.

OPEN carries the bridge's configuration. The bridge answers with READY, or with FAULT if it cannot start. CLOSE ends the
bridge. BIND opens a channel, and UNBIND closes it. ACK allows the next message of a channel. ASK is a question about the
network, and TOLD is its answer. NOTE is a text for the log. HANGUP says that a connection has ended.
"""


class Pipe:
    """A connected socket that carries frames. `send` is thread-safe; only one thread may receive."""

    def __init__(self, sock):
        self._sock = sock
        self._sending = threading.Lock()
        self._rest = bytearray()
        self._fds = []

    def send(self, kind, channel=0, number=0, body=b""):
        """Send a frame. If the pipe is full, this call blocks until the agent reads."""
        size = len(body)
        with self._sending:
            if size >= LARGE and hasattr(os, "memfd_create"):
                fd = os.memfd_create("ravestate")
                try:
                    rest = memoryview(body)
                    while rest:
                        rest = rest[os.write(fd, rest) :]
                    self._send_with(fd, HEAD.pack(kind, SHARED, channel, number, size))
                finally:
                    os.close(fd)
            else:
                self._sock.sendall(HEAD.pack(kind, 0, channel, number, size) + bytes(body))

    def hand_over(self, sock, kind, number, value):
        """Send a connected socket to the agent, in a frame whose body is a value as JSON."""
        body = json.dumps(value).encode()
        with self._sending:
            self._send_with(sock.fileno(), HEAD.pack(kind, PASSED, 0, number, len(body)) + body)

    def _send_with(self, fd, data):
        sent = self._sock.sendmsg([data], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array("i", [fd]))])
        self._sock.sendall(data[sent:])

    def tell(self, kind, value, channel=0, number=0):
        """Send a frame whose body is a value as JSON."""
        self.send(kind, channel, number, json.dumps(value).encode())

    def note(self, channel, text, level="warning"):
        """Send a note about a channel for the agent's log. Channel 0 means the whole node."""
        self.tell(NOTE, {"text": text, "level": level}, channel)

    def receive(self):
        """Wait for a frame; return its kind, channel, number and body.

        Raises:
            EOFError: The agent has closed the pipe.
        """
        kind, flags, channel, number, size = HEAD.unpack(self._take(HEAD.size))
        if flags & SHARED:
            fd = self._fds.pop(0)
            try:
                body = mmap.mmap(fd, size, access=mmap.ACCESS_READ)
            finally:
                os.close(fd)
            return kind, channel, number, memoryview(body)
        return kind, channel, number, self._take(size)

    def _take(self, size):
        while len(self._rest) < size:
            fds = array.array("i")
            block, ancillary, _, _ = self._sock.recvmsg(1 << 16, socket.CMSG_LEN(16 * fds.itemsize))
            for level, type_, data in ancillary:
                if level == socket.SOL_SOCKET and type_ == socket.SCM_RIGHTS:
                    fds.frombytes(data[: len(data) - len(data) % fds.itemsize])
            self._fds.extend(fds)
            if not block:
                raise EOFError
            self._rest += block
        taken = bytes(self._rest[:size])
        del self._rest[:size]
        return taken


class Outlet:
    """Carries the messages of one subscription to the agent.

    With `latest`, a message waits until the agent has acknowledged the previous message. A newer message replaces the
    waiting message.
    """

    def __init__(self, pipe, channel, latest):
        self._pipe, self._channel, self._latest = pipe, channel, latest
        self._lock = threading.Lock()
        self._busy = False
        self._pending = None

    def put(self, body: bytes | memoryview) -> None:
        """Pass on a message."""
        if self._latest:
            with self._lock:
                if self._busy:
                    self._pending = body
                    return
                self._busy = True
        self._pipe.send(MESSAGE, self._channel, 0, body)

    def acknowledge(self):
        """Record that the agent has handled the last message. Send the waiting message, if there is one."""
        with self._lock:
            body, self._pending = self._pending, None
            self._busy = body is not None
        if body is not None:
            self._pipe.send(MESSAGE, self._channel, 0, body)


def serve(open_node):
    """Connect to the agent, and carry out its orders until the agent closes the pipe.

    Args:
        open_node: A function that takes the pipe and the configuration. It returns an object with the methods ``bind``,
            ``unbind``, ``message``, ``call``, ``answer``, ``cancel``, ``ask`` and ``close``, and for ROS 1 also
            ``hang_up``.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the agent reacts to Ctrl-C, and ends this process cleanly
    pipe = Pipe(socket.socket(fileno=int(sys.argv[1])))
    try:
        kind, _, _, body = pipe.receive()
        assert kind == OPEN
        try:
            node = open_node(pipe, json.loads(bytes(body)))
        except BaseException as error:
            pipe.tell(FAULT, reason(error))
            return
        pipe.send(READY)
        _obey(pipe, node)
        node.close()
    except (EOFError, OSError):
        pass
    finally:
        sys.stdout.flush()
        os._exit(0)  # the libraries' threads must not keep the process alive


def _obey(pipe, node):
    outlets = {}
    while True:
        kind, channel, number, body = pipe.receive()
        try:
            if kind == BIND:
                binding = json.loads(body)
                if binding["kind"] == "subscriber":
                    outlets[channel] = Outlet(pipe, channel, binding["latest"])
                node.bind(channel, binding, outlets.get(channel))
            elif kind == ACK:
                if channel in outlets:
                    outlets[channel].acknowledge()
            elif kind == MESSAGE:
                node.message(channel, body)
            elif kind == CALL:
                node.call(channel, number, body)
            elif kind in (ANSWER, FAULT):
                node.answer(channel, number, body, kind == FAULT)
            elif kind == CANCEL:
                node.cancel(channel, number)
            elif kind == UNBIND:
                outlets.pop(channel, None)
                node.unbind(channel)
            elif kind == HANGUP:
                node.hang_up(number)
            elif kind == ASK:
                pipe.tell(TOLD, node.ask(), 0, number)
            elif kind == CLOSE:
                return
        except (EOFError, BrokenPipeError):
            raise
        except Exception as error:  # the agent gets the reason, and the process continues
            if kind == ASK:
                pipe.tell(TOLD, {"error": reason(error)}, 0, number)
            elif kind == CALL:
                pipe.tell(FAULT, reason(error), channel, number)
            else:
                pipe.tell(NOTE, {"text": reason(error), "level": "error", "failed": kind == BIND}, channel)


def reason(error):
    """Return the type and the message of an exception as text."""
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def every(seconds, function):
    """Call a function every `seconds` seconds, in a thread, until the process ends."""

    def run():
        while True:
            time.sleep(seconds)
            function()

    threading.Thread(target=run, daemon=True).start()
