"""The interface between small talk and a language model, and a stand-in until the model is chosen."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import aclosing
from dataclasses import dataclass
from typing import Any, Literal, Protocol

from ravestate.errors import PlatformError

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
            stop: Texts before which the model stops.

        Raises:
            PlatformError: The model failed, or its server refused, stalled or disconnected.
        """
        ...

    async def close(self) -> None:
        """Release everything. A second call does nothing."""
        ...


class PendingBackend:
    """A stand-in while the backend is being chosen. Its calls wait, and then go to the chosen backend."""

    def __init__(self) -> None:
        """Prepare the stand-in. Call this on the event loop."""
        self._chosen: asyncio.Future[Backend] = asyncio.get_running_loop().create_future()

    def resolve(self, backend: Backend | None, fault: PlatformError | None = None) -> None:
        """Pass the chosen backend to the waiting calls. If there is none, these calls raise `fault`."""
        if backend is not None:
            self._chosen.set_result(backend)
        else:
            self._chosen.set_exception(fault or PlatformError("wildtalk: the agent ended before it had a model"))
            self._chosen.exception()  # otherwise, asyncio would log the fault if no call waits

    async def settled(self) -> Backend | None:
        """Wait for the choice, and return the chosen backend; None if the choice found none."""
        try:
            return await asyncio.shield(self._chosen)
        except PlatformError:
            return None

    async def load(self, progress: Progress | None = None) -> None:
        """See `Backend.load`."""
        await (await asyncio.shield(self._chosen)).load(progress)

    async def stream(self, messages: Sequence[Message], **options: Any) -> AsyncGenerator[str, None]:
        """See `Backend.stream`."""
        async with aclosing((await asyncio.shield(self._chosen)).stream(messages, **options)) as pieces:
            async for piece in pieces:
                yield piece

    async def close(self) -> None:
        """Do nothing: this does not close the chosen backend."""
