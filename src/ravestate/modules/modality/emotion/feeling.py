"""The names of feelings."""

from __future__ import annotations

from typing import Literal

Feeling = Literal["shy", "surprised", "happy", "affectionate", "sad"]
"""The name of a feeling and of its signal."""

FEELINGS: tuple[Feeling, ...] = ("shy", "surprised", "happy", "affectionate", "sad")
