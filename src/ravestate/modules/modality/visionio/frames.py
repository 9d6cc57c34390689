"""The camera of a platform. It keeps only the newest picture."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import dataclass
from typing import Any

from ravestate.errors import PlatformError

ENCODINGS = ("rgb8", "bgr8", "rgba8", "bgra8", "mono8")
"""The kinds of raw pixels."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A picture in memory. It is never written to a file.

    Attributes:
        data: An encoded picture (JPEG, PNG), or raw pixels, row after row.
        shape: The height and the width of raw pixels; None for an encoded picture.
        encoding: The kind of raw pixels, one of `ENCODINGS` (the names of ROS).
        step: The length in bytes of a row of raw pixels, including padding; 0 if rows have no padding.
    """

    data: bytes
    shape: tuple[int, int] | None = None
    encoding: str = "rgb8"
    step: int = 0

    def __repr__(self) -> str:
        return f"Frame({len(self.data)} bytes)"


class Frames:
    """The camera of a platform, for example of a web page or a robot. It keeps only the newest picture.

    Example:
        ::

            @page.rule(when=connected, writes=visionio.camera)
            async def open_eyes(ctx):
                ctx[visionio.camera] = frames = visionio.Frames()
                frames.put(jpeg)        # for each picture, from any thread
    """

    def __init__(self) -> None:
        self.dropped = 0
        """How many pictures were dropped because newer ones had come."""
        self.closed = False
        """Whether the camera is closed, so that no more pictures come."""
        self._newest: Frame | None = None
        self._lock = threading.Lock()
        self._waiting: set[tuple[asyncio.AbstractEventLoop, asyncio.Event]] = set()

    def put(self, data: bytes | bytearray | memoryview, shape: tuple[int, int] | None = None) -> None:
        """Accept a new picture, which replaces the previous one. Thread-safe.

        Args:
            data: An encoded picture (JPEG, PNG), or raw RGB pixels.
            shape: The height and the width (pixels) of raw pixels; None for an encoded picture.
        """
        self._put(Frame(bytes(data), shape))

    def put_message(self, message: Any) -> None:
        """Accept a new picture from ROS. Thread-safe.

        Args:
            message: A message with the fields of ``sensor_msgs/Image`` or ``CompressedImage``.

        Raises:
            PlatformError: The message's encoding is not in `ENCODINGS`.
        """
        encoding = getattr(message, "encoding", None)
        if encoding is None:
            self._put(Frame(bytes(message.data)))
            return
        encoding = {"8UC3": "bgr8", "8UC1": "mono8"}.get(encoding, encoding)
        if encoding not in ENCODINGS:
            raise PlatformError(
                f"visionio: a picture has the encoding {encoding!r}: publish one of {', '.join(ENCODINGS)}, or a compressed picture"
            )
        self._put(Frame(bytes(message.data), (message.height, message.width), encoding, message.step))

    def _put(self, frame: Frame) -> None:
        with self._lock:
            if self.closed:
                return
            self.dropped += self._newest is not None
            self._newest = frame
            self._wake()

    def close(self) -> None:
        """Close the camera: no more pictures come. The agent then treats all visible people as gone. Thread-safe."""
        with self._lock:
            self.closed = True
            self._wake()

    async def next(self) -> Frame | None:
        """Wait for a new picture, and return it. Return None if the camera is closed."""
        while True:
            with self._lock:
                frame, self._newest = self._newest, None
                if frame is not None:
                    self._wake()
                if frame is not None or self.closed:
                    return frame
                waiter = self._join()
            await self._wait(waiter)

    async def taken(self) -> None:
        """Wait until `next` has returned the newest picture, or the camera is closed.

        Then the caller can `put` another picture.
        """
        while True:
            with self._lock:
                if self._newest is None or self.closed:
                    return
                waiter = self._join()
            await self._wait(waiter)

    def _join(self) -> tuple[asyncio.AbstractEventLoop, asyncio.Event]:
        waiter = asyncio.get_running_loop(), asyncio.Event()
        self._waiting.add(waiter)
        return waiter

    async def _wait(self, waiter: tuple[asyncio.AbstractEventLoop, asyncio.Event]) -> None:
        try:
            await waiter[1].wait()
        finally:
            with self._lock:
                self._waiting.discard(waiter)  # if the call is cancelled, its loop may close before the next picture

    def _wake(self) -> None:
        waiting, self._waiting = self._waiting, set()
        for loop, event in waiting:
            loop.call_soon_threadsafe(event.set)
