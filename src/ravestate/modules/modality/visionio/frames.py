"""The camera of a platform: the place for its newest picture."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A picture in memory. It is never written to a file.

    Attributes:
        data: An encoded picture (JPEG, PNG), or raw pixels: RGB, a byte each, row after row.
        shape: The height and the width of raw pixels; None for an encoded picture.
    """

    data: bytes
    shape: tuple[int, int] | None = None

    def __repr__(self) -> str:
        return f"Frame({len(self.data)} bytes)"


class Frames:
    """The pictures of a platform's camera: a web page, a robot. Only the newest is kept.

    Example:
        ::

            @page.rule(when=connected, writes=visionio.camera)
            async def open_eyes(ctx):
                ctx[visionio.camera] = frames = visionio.Frames()
                frames.put(jpeg)        # for each picture, from any thread
    """

    def __init__(self) -> None:
        self.dropped = 0
        """The number of pictures that were dropped, because newer ones had come."""
        self.closed = False
        """Whether no more pictures come."""
        self._newest: Frame | None = None
        self._lock = threading.Lock()
        self._waiting: tuple[asyncio.AbstractEventLoop, asyncio.Event] | None = None

    def put(self, data: bytes | bytearray | memoryview, shape: tuple[int, int] | None = None) -> None:
        """Take a picture. Thread-safe.

        Args:
            data: An encoded picture (JPEG, PNG), or raw RGB pixels.
            shape: The height and the width (pixels) of raw pixels; None for an encoded picture.
        """
        with self._lock:
            if self.closed:
                return
            self.dropped += self._newest is not None
            self._newest = Frame(bytes(data), shape)
            self._wake()

    def close(self) -> None:
        """Note that no more pictures come, so that the people leave whom the agent sees. Thread-safe."""
        with self._lock:
            self.closed = True
            self._wake()

    async def next(self) -> Frame | None:
        """Wait for the newest picture that has not been taken; None once the camera is closed."""
        while True:
            with self._lock:
                frame, self._newest = self._newest, None
                if frame is not None or self.closed:
                    return frame
                event = asyncio.Event()
                self._waiting = asyncio.get_running_loop(), event
            await event.wait()

    def _wake(self) -> None:
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting[0].call_soon_threadsafe(waiting[1].set)
