"""The emoji of feelings."""

from __future__ import annotations

import random

from .feeling import Feeling

EMOJI: dict[Feeling, tuple[str, ...]] = {
    "shy": ("😳", "🙈", "☺️"),
    "surprised": ("😮", "😲", "😯"),
    "happy": ("😄", "😀", "😊"),
    "affectionate": ("🤗", "🥰", "💕"),
    "sad": ("😢", "😔", "🥺"),
}
"""The emoji of each feeling."""


def emoji_for(feeling: Feeling, rng: random.Random) -> str:
    """Choose an emoji for a feeling."""
    return rng.choice(EMOJI[feeling])
