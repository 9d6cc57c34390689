"""The line, which carries sound between the agent and a user's microphone and loudspeaker."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Protocol

IN_RATE = 16_000
"""The sampling rate of the user's sound (Hz)."""

OUT_RATE = 24_000
"""The sampling rate of the agent's sound (Hz)."""


class Line(Protocol):
    """A microphone and a loudspeaker. All sound is mono PCM: 16 bits, signed, little-endian.

    A platform that carries sound, for example a web page, puts a line into `rawio.sound`. A module that recognises and
    synthesises speech uses this line.
    """

    @property
    def cancels_echo(self) -> bool:
        """Whether the user's sound comes without the loudspeaker's echo, as from a browser."""
        ...

    @property
    def ended(self) -> bool:
        """Whether a recording in place of a microphone has ended. After its end, `blocks` yields silence."""
        ...

    def blocks(self) -> AsyncIterator[bytes]:
        """Yield the user's sound at `IN_RATE`, in blocks of about 20 ms, until the line is closed."""
        ...

    def play(self, sound: bytes) -> None:
        """Queue sound at `OUT_RATE` for the loudspeaker. It plays after the sound that is queued already."""
        ...

    def stop(self) -> None:
        """Drop all queued sound, and silence the loudspeaker immediately."""
        ...

    @property
    def played(self) -> float:
        """How many seconds of sound the loudspeaker has played since the line was opened. Pauses do not count."""
        ...

    async def drained(self) -> None:
        """Wait until all queued sound has been played or dropped."""
        ...

    def close(self) -> None:
        """Close the line: `blocks` ends, and no further sound plays."""
        ...
