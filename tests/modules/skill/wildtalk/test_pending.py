"""Calls of a backend wait until the backend has been chosen."""

import asyncio

import pytest

from ravestate.errors import PlatformError
from ravestate.language.chat import Message
from ravestate.modules.skill.wildtalk.listening import ListeningBackend
from ravestate.modules.skill.wildtalk.pending import PendingBackend


def test_calls_wait_for_the_chosen_backend() -> None:
    async def main() -> None:
        pending = PendingBackend()

        begun = asyncio.Event()

        async def answer() -> str:
            begun.set()
            await pending.load()
            return "".join([piece async for piece in pending.stream([Message("user", "Hello.")], seed=1)])

        waiting = asyncio.create_task(answer())
        gone = asyncio.create_task(pending.load())
        await begun.wait()
        assert not waiting.done()
        gone.cancel()
        pending.resolve(ListeningBackend())
        assert await waiting
        await pending.close()

    asyncio.run(main())


def test_if_no_backend_is_found_the_waiting_calls_raise_the_reason() -> None:
    async def main() -> None:
        pending, other = PendingBackend(), PendingBackend()
        pending.resolve(None, PlatformError("no such file"))
        other.resolve(None)
        with pytest.raises(PlatformError, match="no such file"):
            await pending.load()
        with pytest.raises(PlatformError, match="before it had a model"):
            await other.load()

    asyncio.run(main())
