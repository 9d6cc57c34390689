"""A backend that is still being chosen."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Sequence
from contextlib import aclosing
from typing import Any

from ravestate.errors import PlatformError

from .backend import Backend, Message, Progress


class PendingBackend:
    """A stand-in during the choice: its calls wait for the chosen backend, and are passed on to it."""

    def __init__(self) -> None:
        """Make it on the event loop."""
        self._chosen: asyncio.Future[Backend] = asyncio.get_running_loop().create_future()

    def resolve(self, backend: Backend | None, fault: PlatformError | None = None) -> None:
        """Pass the chosen backend to the calls that wait. Without a backend they raise `fault`."""
        if backend is not None:
            self._chosen.set_result(backend)
        else:
            self._chosen.set_exception(fault or PlatformError("wildtalk: the agent ended before it had a model"))
            self._chosen.exception()  # otherwise asyncio complains if no call waits

    async def settled(self) -> Backend | None:
        """Return the chosen backend as soon as there is one; None if there is none."""
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
        """Do nothing: the chosen backend is closed by its own user."""
