"""The manner in which a sentence is spoken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Prosody:
    """The manner of speech. Each value is a factor; 1 is the voice's normal manner.

    Attributes:
        rate: The speed.
        pitch: The height of the voice, if the backend can change it (espeak-ng).
        range: The liveliness of the melody.
    """

    rate: float = 1.0
    pitch: float = 1.0
    range: float = 1.0


FEELINGS: Mapping[str, Prosody] = {
    "happy": Prosody(1.08, 1.2, 1.4),
    "surprised": Prosody(1.1, 1.35, 1.6),
    "affectionate": Prosody(0.94, 1.05, 1.1),
    "shy": Prosody(0.92, 0.92, 0.8),
    "sad": Prosody(0.85, 0.8, 0.6),
}
"""The manner of speech for each feeling of the agent."""
