"""A function that waits until the user or the agent leaves a conversation."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ravestate.runtime.context import Context


async def agent_left(context: Context, user: Coroutine[Any, Any, object]) -> bool:
    """Wait until the coroutine `user` ends (the user has left), or until the agent stops its context.

    Returns:
        Whether the agent has stopped its context. If so, the coroutine is cancelled.

    Raises:
        RavestateError: The agent has stopped because of this error.
        Exception: The coroutine has raised this error.
    """
    following = asyncio.create_task(user)
    stopped = asyncio.create_task(context.until_stopped())
    try:
        await asyncio.wait((following, stopped), return_when=asyncio.FIRST_COMPLETED)
        (stopped if stopped.done() else following).result()
        return stopped.done()
    finally:
        following.cancel()
        stopped.cancel()
