"""A WebSocket with manners, whatever language is spoken on it: what it takes, for how long, and how it ends."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Coroutine
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from .protocol import CLOSING_CODES, Error, ProtocolError, serialise

__all__ = ["LONGEST", "Channel"]

LONGEST = 128 * 1024
"""Bytes that a frame may have: JSON may write a character with twelve, and the longest text has 10,000."""

SILENT = 10.0
"""Seconds within which a client says hello."""


class Channel:
    """Carries frames, as text, between a client and who serves it.

    Args:
        socket: Not accepted yet.
        replies: How many may wait for the client. Who asks on and on, and does not read, is dropped.
    """

    def __init__(self, socket: WebSocket, replies: int) -> None:
        self._socket = socket
        self._most = replies
        self._replies: deque[str] = deque()
        self.woken = asyncio.Event()
        """Whether there is something to send, a reply for one."""

    async def carry(self, serve: Callable[[], Awaitable[None]]) -> None:
        """Accept the client, and serve it until either side closes. What is wrong with it, as a `ProtocolError`, is told."""
        try:
            await self._socket.accept()
            try:
                await serve()
            except ProtocolError as error:
                await self.send(serialise(Error(error.code, str(error))))
                await self._socket.close(
                    CLOSING_CODES.get(error.code, CLOSING_CODES["malformed"]), error.code
                )
        except WebSocketDisconnect:
            pass

    async def both(self, read: Coroutine[Any, Any, None], write: Coroutine[Any, Any, None]) -> None:
        """Read and write until either ends."""
        tasks = [asyncio.create_task(read), asyncio.create_task(write)]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
        for end in await asyncio.gather(*tasks, return_exceptions=True):
            if isinstance(end, Exception):
                raise end

    async def first(self, expected: str) -> str | bytes:
        """The first frame, which comes soon.

        Args:
            expected: What it looks like.

        Raises:
            ProtocolError: It does not come, or see `receive`.
        """
        try:
            async with asyncio.timeout(SILENT):
                return await self.receive()
        except TimeoutError:
            raise ProtocolError("silent", f"no hello within {SILENT:g} s: begin with {expected}") from None

    async def receive(self) -> str | bytes:
        """The next frame.

        Raises:
            ProtocolError: It is too large.
        """
        message = await self._socket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", 1006))
        text: str | bytes = message.get("text") or message.get("bytes") or ""
        if len(text) > LONGEST:  # most servers refuse it themselves
            raise ProtocolError("too-large", f"a frame has at most {LONGEST:,} bytes, not {len(text):,}")
        return text

    async def send(self, text: str) -> None:
        """Send a frame now."""
        await self._socket.send_text(text)

    def reply(self, text: str) -> None:
        """Have a frame sent by who writes."""
        if len(self._replies) >= self._most:
            raise WebSocketDisconnect(1008, "it does not read")
        self._replies.append(text)
        self.woken.set()

    async def send_replies(self) -> None:
        """Send what was replied since."""
        while self._replies:
            await self.send(self._replies.popleft())

    async def end(self) -> None:
        """Close it, as all was said."""
        await self._socket.close(CLOSING_CODES["ended"], "ended")
