"""A line to the machine's microphone and loudspeaker, by PortAudio."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from collections.abc import AsyncIterator
from importlib import import_module
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules.modality.rawio.line import IN_RATE, OUT_RATE

BLOCK = 0.02
"""The length of a block (seconds)."""
WAITING = 200
"""At most this many blocks of sound wait for a slow agent. Older blocks are dropped."""
GONE = 2.0
"""A device counts as unplugged if it carries no sound for this many seconds."""
AGAIN = 2.0
"""The time between two attempts to open an unplugged device (seconds)."""

log = logging.getLogger("ravestate.voiceio")


class DeviceLine:
    """A line to a microphone and a loudspeaker of this machine.

    Args:
        source, sink: The names of the devices, or parts of the names. ``default`` is the system's choice. An empty name
            means no device.

    Raises:
        PlatformError: PortAudio is missing, or a device cannot be opened.
    """

    cancels_echo = False
    """Always False: the microphone's sound may contain the loudspeaker's echo."""
    ended = False
    """Always False: a microphone's sound does not end."""

    def __init__(self, source: str = "default", sink: str = "default") -> None:
        self._names = source, sink
        self._loop = asyncio.get_running_loop()
        self._blocks: asyncio.Queue[bytes | None] = asyncio.Queue(WAITING)
        self._lock = threading.Lock()
        self._queue = bytearray()
        self._played = 0
        self._empty = asyncio.Event()
        self._empty.set()
        self._closed = False
        self._streams: list[Any] = []
        self._taken = self._given = 0.0
        self.lost = 0
        """The number of times that a device was unplugged."""
        self._open()
        self._watch = asyncio.create_task(self._keep_open())

    def _open(self, *, again: bool = False) -> None:
        """Open the devices. If `again` is true, ignore a missing loudspeaker, so that the agent can keep listening."""
        sound = portaudio()
        parts = (
            ("microphone", "source", sound.RawInputStream, IN_RATE, self._take),
            ("loudspeaker", "sink", sound.RawOutputStream, OUT_RATE, self._give),
        )
        self._taken = self._given = self._loop.time()
        for name, (what, setting, stream, rate, callback) in zip(self._names, parts, strict=True):
            if not name:
                continue
            device = None if name == "default" else name
            try:
                with contextlib.ExitStack() as failed:
                    opened = stream(
                        rate, round(BLOCK * rate), device=device, callback=callback, channels=1, dtype="int16"
                    )
                    failed.callback(opened.close)
                    opened.start()
                    failed.pop_all()
                self._streams.append(opened)
            except (sound.PortAudioError, ValueError) as error:
                if again and what == "loudspeaker":
                    self.stop()  # drop the inaudible sound; the next sound makes `_keep_open` look for the loudspeaker
                    continue
                self._shut()
                raise PlatformError(
                    f"voiceio cannot open the {what} ({error}): choose one with --set voiceio.{setting}=NAME; "
                    "`ravestate voice check` lists the devices"
                ) from error

    async def blocks(self) -> AsyncIterator[bytes]:
        """Yield the microphone's sound. If an unplugged device comes back, the line opens it again."""
        while not self._closed and (block := await self._blocks.get()) is not None:
            yield block

    async def _keep_open(self) -> None:
        """Open the devices again if one has been unplugged. PortAudio then carries no sound, and reports no error."""
        while not self._closed:
            await asyncio.sleep(GONE / 4)
            late = self._loop.time() - GONE
            if self._names[0] and self._taken < late:
                await self._reopen("microphone")
            elif self._queue and self._given < late:
                await self._reopen("loudspeaker")

    async def _reopen(self, what: str) -> None:
        self.lost += 1
        log.warning("the %s is gone: looking for it again", what)
        self._shut()
        while not self._closed:
            with contextlib.suppress(PlatformError):
                await asyncio.to_thread(restart)
                self._open(again=True)
                whole = len(self._streams) == len([name for name in self._names if name])
                log.warning("the %s is back" if whole else "the %s is still away: the agent goes on without it", what)
                return
            self.stop()
            await asyncio.sleep(AGAIN)

    def play(self, sound: bytes) -> None:
        """Queue sound for the loudspeaker."""
        with self._lock:
            if sound and not self._closed:
                if not self._queue:
                    self._given = self._loop.time()
                self._queue += sound
                self._empty.clear()

    def stop(self) -> None:
        """Drop the queued sound."""
        with self._lock:
            self._queue.clear()
        self._empty.set()

    @property
    def played(self) -> float:
        """How many seconds of sound the loudspeaker has accepted."""
        return self._played / 2 / OUT_RATE

    async def drained(self) -> None:
        """Wait until the queued sound has been played or dropped."""
        await self._empty.wait()

    def close(self) -> None:
        """Close the devices."""
        self._closed = True
        self._watch.cancel()
        self._shut()
        self.stop()
        self._put(None)

    def _shut(self) -> None:
        streams, self._streams = self._streams, []
        for stream in streams:
            with contextlib.suppress(Exception):  # an unplugged device may refuse
                stream.abort()
                stream.close()

    # The following methods run in PortAudio's threads.

    def _take(self, data: Any, *_: Any) -> None:
        self._taken = self._loop.time()
        with contextlib.suppress(RuntimeError):  # the loop is closed
            self._loop.call_soon_threadsafe(self._put, bytes(data))

    def _give(self, data: Any, *_: Any) -> None:
        with self._lock:
            self._given = self._loop.time()
            part = bytes(self._queue[: len(data)])
            del self._queue[: len(data)]
            self._played += len(part)
            done = bool(part) and not self._queue
        data[:] = part.ljust(len(data), b"\0")
        if done:
            with contextlib.suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(self._drained)

    # The following methods run on the loop.

    def _put(self, block: bytes | None) -> None:
        if self._blocks.full():
            self._blocks.get_nowait()
        self._blocks.put_nowait(block)

    def _drained(self) -> None:
        if not self._queue:
            self._empty.set()


def portaudio() -> Any:
    """Return the package sounddevice.

    Raises:
        PlatformError: The package or the library PortAudio is missing.
    """
    try:
        return import_module("sounddevice")  # the package has no types
    except ImportError as error:
        raise PlatformError("voiceio needs sounddevice: pip install 'ravestate[voice]'") from error
    except OSError as error:
        raise PlatformError(
            "voiceio needs PortAudio: apt-get install libportaudio2 (or brew install portaudio)"
        ) from error


def restart() -> None:
    """Make PortAudio look for devices again. It knows only the devices that were there when it started.

    Raises:
        PlatformError: PortAudio does not start.
    """
    sound = portaudio()
    try:
        sound._terminate()
        sound._initialize()
    except sound.PortAudioError as error:
        raise PlatformError(f"voiceio: PortAudio does not start again: {error}") from error
