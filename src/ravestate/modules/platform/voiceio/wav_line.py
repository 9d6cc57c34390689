"""A line to files: a recording replaces the microphone, and a WAV file replaces the loudspeaker."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.modules.modality.rawio.line import IN_RATE, OUT_RATE

from .playout import PlayOut
from .sound import decode, silence, write_wav

BLOCK = 0.02
"""The length of a block (seconds)."""


class WavLine:
    """A line whose microphone plays a recording, and then silence.

    The line keeps the time of the event loop, which may be virtual.

    Args:
        source: The recording, in any usual format; None for silence.
        sink: The WAV file for the loudspeaker's sound. It starts when the recording starts. None drops the sound.

    Raises:
        PlatformError: The recording cannot be read, or the WAV file cannot be written.
    """

    cancels_echo = False
    """Always False: the recording may contain an echo."""

    def __init__(self, source: Path | None, sink: Path | None = None) -> None:
        if sink is not None:
            check_target(sink)
        self._sound = b"" if source is None else decode(source, IN_RATE)
        self._sink = sink
        self._out = PlayOut()
        self._changed = asyncio.Event()
        self._begun: float | None = None
        self._closed = False
        self.ended = False
        """Whether the recording has ended."""

    def begin(self) -> float:
        """Start the recording and the WAV file now, and return this time. `blocks` calls this method, too."""
        self._begun = _now()
        return self._begun

    async def blocks(self) -> AsyncIterator[bytes]:
        """Yield the recording in blocks of 20 ms, and then silence."""
        loop, begun = asyncio.get_running_loop(), self.begin()
        size = 2 * round(BLOCK * IN_RATE)
        number = 0
        while not self._closed:
            block = self._sound[number * size : (number + 1) * size]
            number += 1
            await asyncio.sleep(begun + number * BLOCK - loop.time())
            self.ended = number * size >= len(self._sound)
            yield block.ljust(size, b"\0")

    def play(self, sound: bytes) -> None:
        """Queue sound for the loudspeaker."""
        if not self._closed:
            self._out.play(sound, _now())
            self._changed.set()

    def stop(self) -> None:
        """Drop the queued sound."""
        self._out.stop(_now())
        self._changed.set()

    @property
    def played(self) -> float:
        """How many seconds of sound have been played."""
        return self._out.played(_now())

    async def drained(self) -> None:
        """Wait until the queued sound has been played or dropped."""
        while (left := self._out.end - _now()) > 1e-9:
            self._changed.clear()
            try:
                async with asyncio.timeout(left):
                    await self._changed.wait()
            except TimeoutError:
                pass

    def close(self) -> None:
        """End the line, and write the file. If the recording never began, write nothing.

        Raises:
            PlatformError: The file cannot be written.
        """
        if self._closed:
            return
        self._closed = True
        self._out.stop(_now())
        if self._sink is not None and self._begun is not None:
            write_wav(self._sink, self._on_time_line(self._begun, _now()), OUT_RATE)

    def _on_time_line(self, begin: float, end: float) -> bytes:
        sound = bytearray(silence(end - begin, OUT_RATE))
        for time, part in self._out.parts():
            at = 2 * round((time - begin) * OUT_RATE)
            sound[at : at + len(part)] = part
        return bytes(sound)


def check_target(path: Path) -> None:
    """Make sure that a WAV file can be written, so that the sound of a long conversation is not lost at its end.

    Raises:
        PlatformError: The name does not end in ``.wav``, or the file cannot be written.
    """
    if path.suffix.lower() != ".wav":
        raise PlatformError(f"cannot write {path}: the sound is written as WAV, so name a file that ends in .wav")
    try:
        path.open("ab").close()
    except OSError as error:
        raise PlatformError(f"cannot write {path}: {error.strerror}") from error


def _now() -> float:
    return asyncio.get_running_loop().time()
