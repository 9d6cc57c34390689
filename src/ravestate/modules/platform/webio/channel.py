"""A WebSocket for any protocol. It limits the size of frames, the wait for the first one, and the queue of replies."""

from __future__ import annotations

import asyncio
import contextlib
from collections import deque
from collections.abc import Awaitable, Callable

from starlette.websockets import WebSocket, WebSocketDisconnect

from .fields import CLOSING_CODES, ProtocolError
from .frames import Error
from .protocol import serialise

LONGEST = 128 * 1024
"""The maximum number of bytes in a frame. A text may have 10,000 characters, each up to twelve bytes in JSON."""

SILENT = 10.0  # the server waits this many seconds for the client's first frame


class Channel:
    """Carries frames as text over a WebSocket that the server has not accepted yet.

    At most `replies` replies wait to be sent. A client that keeps asking without reading the replies is disconnected.
    """

    def __init__(self, socket: WebSocket, replies: int) -> None:
        self._socket = socket
        self._most = replies
        self._replies: deque[str] = deque()
        self.woken = asyncio.Event()
        """An event that is set when there is something to send, for example a reply."""

    async def carry(self, serve: Callable[[], Awaitable[None]]) -> None:
        """Accept the client, and run `serve` until either side closes. Report a `ProtocolError` to the client."""
        with contextlib.suppress(WebSocketDisconnect):
            await self._socket.accept()
            try:
                await serve()
            except ProtocolError as error:
                await self.send(serialise(Error(error.code, str(error))))
                await self._socket.close(CLOSING_CODES.get(error.code, CLOSING_CODES["malformed"]), error.code)

    async def first(self, expected: str) -> str | bytes:
        """Return the client's first frame. `expected` is an example of such a frame, for the error message.

        Raises:
            ProtocolError: No frame comes within `SILENT` seconds, or the frame is too large.
        """
        try:
            async with asyncio.timeout(SILENT):
                return await self.receive()
        except TimeoutError:
            raise ProtocolError("silent", f"no hello within {SILENT:g} s: begin with {expected}") from None

    async def receive(self) -> str | bytes:
        """Return the client's next frame, or raise a `ProtocolError` if it is too large."""
        message = await self._socket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", 1006))
        text: str | bytes = message.get("text") or message.get("bytes") or ""
        size = len(text.encode(errors="surrogatepass") if isinstance(text, str) else text)
        if size > LONGEST:  # most servers themselves refuse such frames
            raise ProtocolError("too-large", f"a frame has at most {LONGEST:,} bytes, not {size:,}")
        return text

    async def send(self, text: str) -> None:
        """Send a frame to the client now, without the queue."""
        await self._socket.send_text(text)

    async def send_sound(self, sound: bytes | memoryview) -> None:
        """Send a binary frame to the client now, without the queue."""
        await self._socket.send_bytes(bytes(sound))

    def reply(self, text: str) -> None:
        """Queue a frame. The writing task later calls `send_replies`, which sends it.

        Raises:
            WebSocketDisconnect: The queue is full, because the client does not read.
        """
        if len(self._replies) >= self._most:
            raise WebSocketDisconnect(1008, "the client does not read")
        self._replies.append(text)
        self.woken.set()

    async def send_replies(self) -> None:
        """Send the queued frames."""
        while self._replies:
            await self.send(self._replies.popleft())

    async def end(self) -> None:
        """Close the WebSocket with the code for a conversation that has ended."""
        await self._socket.close(CLOSING_CODES["ended"], "ended")


class Bucket:
    """A rate limit (token bucket): a burst of `burst` events, then `rate` events per second. Times are in seconds.

    Example:
        >>> bucket = Bucket(burst=2, rate=0.5, now=0.0)
        >>> [bucket.wait(now=0.0) for _ in range(3)]
        [0.0, 0.0, 2.0]
        >>> bucket.take(now=0.0)
        False
    """

    __slots__ = ("_burst", "_level", "_rate", "_time")

    def __init__(self, *, burst: float, rate: float, now: float) -> None:
        self._burst = burst
        self._rate = rate
        self._level = burst
        self._time = now

    def wait(self, now: float) -> float:
        """Count an event, even beyond the limit. Return how many seconds the event must wait to keep to the limit."""
        self._fill(now)
        self._level -= 1
        return max(0.0, -self._level / self._rate)

    def take(self, now: float, amount: float = 1) -> bool:
        """Count `amount` events, unless they exceed the limit. Return whether they were counted."""
        self._fill(now)
        if self._level < amount:
            return False
        self._level -= amount
        return True

    def _fill(self, now: float) -> None:
        self._level = min(self._burst, self._level + (now - self._time) * self._rate)
        self._time = now
