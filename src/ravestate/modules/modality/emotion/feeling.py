"""The feelings, with their emoji."""

from __future__ import annotations

from typing import Literal

Feeling = Literal["shy", "surprised", "happy", "affectionate", "sad"]
"""The name of a feeling and of its signal."""

EMOJI: dict[Feeling, tuple[str, ...]] = {
    "shy": ("😳", "🙈", "☺️"),
    "surprised": ("😮", "😲", "😯"),
    "happy": ("😄", "😀", "😊"),
    "affectionate": ("🤗", "🥰", "💕"),
    "sad": ("😢", "😔", "🥺"),
}
"""The emoji of each feeling."""
