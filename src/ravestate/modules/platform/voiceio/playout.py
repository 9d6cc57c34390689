"""A play-out clock: it computes which part of the queued sound has been played at a given time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravestate.modules.modality.rawio.line import OUT_RATE

SECOND = 2 * OUT_RATE
"""The number of bytes in a second of sound."""


@dataclass(slots=True)
class _Part:
    begin: float
    sound: bytes

    @property
    def end(self) -> float:
        return self.begin + len(self.sound) / SECOND


class PlayOut:
    """A simulated loudspeaker. All times are seconds on one clock, which must not run backwards."""

    def __init__(self) -> None:
        self._parts: list[_Part] = []

    def play(self, sound: bytes, now: float) -> None:
        """Queue sound at `OUT_RATE`. The sound begins immediately, or after the sound in the queue."""
        if sound:
            self._parts.append(_Part(max(now, self.end), sound))

    def stop(self, now: float) -> None:
        """Drop the sound after `now`."""
        kept: list[_Part] = []
        for part in self._parts:
            if part.end > now:
                part.sound = part.sound[: 2 * max(0, round((now - part.begin) * OUT_RATE))]
            if part.sound:
                kept.append(part)
        self._parts = kept

    @property
    def end(self) -> float:
        """The time at which the queued sound ends; minus infinity before the first sound."""
        return self._parts[-1].end if self._parts else float("-inf")

    def played(self, now: float) -> float:
        """Return how many seconds of sound have been played until `now`. Pauses between sounds do not count."""
        return sum(min(part.end, max(part.begin, now)) - part.begin for part in self._parts)

    def parts(self) -> Iterator[tuple[float, bytes]]:
        """Yield each sound with the time at which it began."""
        return ((part.begin, part.sound) for part in self._parts)
