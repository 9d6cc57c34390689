"""A stand-in for a language model until the model is chosen."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Sequence
from contextlib import aclosing
from typing import Any

from ravestate.errors import PlatformError
from ravestate.language.chat import Backend, Message, Progress


class PendingBackend:
    """A stand-in while the backend is being chosen. Its calls wait, and then go to the chosen backend."""

    def __init__(self) -> None:
        """Prepare the stand-in. Call this on the event loop."""
        self._chosen: asyncio.Future[Backend] = asyncio.get_running_loop().create_future()

    def resolve(self, backend: Backend | None, fault: PlatformError | None = None) -> None:
        """Pass the chosen backend to the waiting calls. If there is none, these calls raise `fault`, or by
        default the error that there is no model."""
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
        """Do nothing: the chosen backend stays open."""
