"""Combine the microphone of one line with the loudspeaker of another, for example a recording with a device.

A *line* is a microphone and a loudspeaker.
"""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import ExitStack
from dataclasses import dataclass

from ravestate.modules.modality.rawio.line import Line


@dataclass(frozen=True, slots=True)
class Pair:
    """A line that takes its microphone and its loudspeaker from two other lines.

    Attributes:
        source: The line that has the microphone.
        sink: The line that has the loudspeaker.
    """

    source: Line
    sink: Line

    @property
    def cancels_echo(self) -> bool:
        """Whether the microphone's sound comes without the loudspeaker's echo."""
        return self.source.cancels_echo

    @property
    def ended(self) -> bool:
        """Whether the microphone's sound has ended."""
        return self.source.ended

    def blocks(self) -> AsyncIterator[bytes]:
        """Yield the microphone's sound."""
        return self.source.blocks()

    def play(self, sound: bytes) -> None:
        """Queue sound for the loudspeaker."""
        self.sink.play(sound)

    def stop(self) -> None:
        """Drop the queued sound."""
        self.sink.stop()

    @property
    def played(self) -> float:
        """How many seconds of sound the loudspeaker has played."""
        return self.sink.played

    async def drained(self) -> None:
        """Wait until the queued sound has been played or dropped."""
        await self.sink.drained()

    def close(self) -> None:
        """Close both lines."""
        with ExitStack() as lines:
            lines.callback(self.sink.close)
            lines.callback(self.source.close)
