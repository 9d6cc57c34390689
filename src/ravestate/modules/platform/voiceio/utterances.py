"""An utterance of the user."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Utterance:
    """The words that the user said in one turn.

    Attributes:
        text: The recognised words; empty if there were none.
        confidence: The recogniser's confidence, from 0 to 1.
        start: The time at which the speech began: seconds on the context's clock, or since the beginning of a file.
        end: The time at which the speech ended, measured like `start`.
    """

    text: str
    confidence: float
    start: float
    end: float
