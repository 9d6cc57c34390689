"""The interface of a language model that chats."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

Role = Literal["system", "user", "assistant"]

Progress = Callable[[float], None]
"""A callback that gets the loaded fraction of a model, 0.0 to 1.0. It is called on the event loop."""


@dataclass(frozen=True, slots=True)
class Message:
    """An utterance (`text`) of a conversation, with its speaker (`role`)."""

    role: Role
    text: str


class Backend(Protocol):
    """A language model. An instance belongs to one event loop."""

    async def load(self, progress: Progress | None = None) -> None:
        """Get ready to answer. Later calls do nothing. If `load` has not been called, `stream` calls it.

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

        Closing the iterator, or cancelling the task that waits for it, stops the model. Wrap the iterator in
        ``contextlib.aclosing`` if your loop may end before the answer is complete.

        Args:
            messages: The conversation, oldest first. The model answers the last message.
            max_tokens: The maximum number of tokens (each about three quarters of an English word).
            temperature: The randomness: 0 always takes the likeliest word, 1 is the model's own distribution.
            seed: The same seed and messages give the same answer, if the model allows it.
            stop: The model stops before it would write one of these texts.

        Raises:
            PlatformError: The model failed, or its server refused, stalled or disconnected.
        """
        ...

    async def close(self) -> None:
        """Release everything. A second call does nothing."""
        ...
