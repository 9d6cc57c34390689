"""What small talk needs of a language model: text, piece by piece, from a conversation."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

__all__ = ["Backend", "Message", "Progress", "Role"]

Role = Literal["system", "user", "assistant"]

Progress = Callable[[float], None]
"""Told how far a model has been loaded: 0.0 to 1.0, on the event loop."""


@dataclass(frozen=True, slots=True)
class Message:
    """One utterance of a conversation: who (`role`) said what (`text`)."""

    role: Role
    text: str


class Backend(Protocol):
    """A language model, wherever it runs. An instance belongs to one event loop."""

    async def load(self, progress: Progress | None = None) -> None:
        """Get ready to answer; called again it does nothing. `stream` calls it if nobody did.

        Raises:
            PlatformError: A package, a file or a server is missing or broken. The message says what to do.
        """
        ...

    def stream(
        self,
        messages: Sequence[Message],
        *,
        max_tokens: int = 96,
        temperature: float = 0.7,
        seed: int | None = None,
        stop: Sequence[str] = (),
    ) -> AsyncGenerator[str, None]:
        """Yield the answer to `messages` in pieces, as the model writes it.

        Closing the iterator, or cancelling the task that waits for it, stops the model. Wrap it in
        ``contextlib.aclosing`` where you may leave before its end.

        Args:
            messages: The conversation, oldest first; the last one is to be answered.
            max_tokens: At most so many tokens (about three quarters of an English word each).
            temperature: 0 is always the likeliest word; 1 is as the model has learnt it.
            seed: The same seed and messages give the same answer, where the model allows it.
            stop: The model stops before it writes any of these.

        Raises:
            PlatformError: The model failed, or its server refused, stalled or broke off.
        """
        ...

    async def close(self) -> None:
        """Let go of everything; called again it does nothing."""
        ...
