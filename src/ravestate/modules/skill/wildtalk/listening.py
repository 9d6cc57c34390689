"""Small talk without a language model: short replies of a listener."""

from __future__ import annotations

import random
from collections.abc import AsyncGenerator, Sequence

from .backend import Message, Progress

TO_A_REMARK = (
    "I see.",
    "Go on, I'm listening.",
    "Tell me more about it.",
    "And what do you think of it?",
    "Oh, really?",
)
TO_A_QUESTION = (
    "I don't know, I'm afraid.",
    "That is hard to say. What do you think?",
    "Good question. I have no answer to it.",
)
RECENT = 4
"""The number of last messages whose phrases are not repeated."""


class ListeningBackend:
    """A stand-in for a missing language model, with phrases for remarks and for questions."""

    async def load(self, progress: Progress | None = None) -> None:
        """Do nothing: there is no model to load."""

    async def stream(
        self,
        messages: Sequence[Message],
        *,
        max_tokens: int = 96,
        temperature: float = 0.7,
        seed: int | None = None,
        stop: Sequence[str] = (),
    ) -> AsyncGenerator[str, None]:
        """Yield a phrase that was not said lately. Only `messages` and `seed` matter."""
        phrases = TO_A_QUESTION if messages[-1].text.rstrip().endswith("?") else TO_A_REMARK
        recent = {message.text for message in messages[-RECENT:]}
        yield random.Random(seed).choice([p for p in phrases if p not in recent] or phrases)

    async def close(self) -> None:
        """Do nothing: there is no model to close."""
