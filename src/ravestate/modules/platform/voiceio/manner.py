"""The manner in which a sentence is spoken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

SLOWEST, MOST = 0.25, 4
"""The smallest `rate` of a `Prosody`, and the greatest value of each of its factors. Beyond these limits, a voice fails
or takes too long."""


@dataclass(frozen=True, slots=True)
class Prosody:
    """The manner of speech. Each value is a factor; 1 is the voice's normal manner.

    Attributes:
        rate: The speed, from 0.25 to 4.
        pitch: The height of the voice, from 0 to 4, if the backend can change it (espeak-ng).
        range: The liveliness of the melody, from 0 to 4.

    Raises:
        ValueError: A value is out of its range. No voice could speak in such a manner.
    """

    rate: float = 1.0
    pitch: float = 1.0
    range: float = 1.0

    def __post_init__(self) -> None:
        for name, value, least in (("rate", self.rate, SLOWEST), ("pitch", self.pitch, 0), ("range", self.range, 0)):
            if not least <= value <= MOST:
                raise ValueError(f"the {name} of a Prosody must be from {least} to {MOST}, not {value}")


FEELINGS: Mapping[str, Prosody] = {
    "happy": Prosody(1.08, 1.2, 1.4),
    "surprised": Prosody(1.1, 1.35, 1.6),
    "affectionate": Prosody(0.94, 1.05, 1.1),
    "shy": Prosody(0.92, 0.92, 0.8),
    "sad": Prosody(0.85, 0.8, 0.6),
}
"""The manner of speech for each feeling of the agent."""
