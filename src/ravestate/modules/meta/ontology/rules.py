"""The rules that open and close memory."""

from __future__ import annotations

import asyncio

import ravestate as rs
from ravestate.errors import PlatformError

from .names import memory, module
from .opening import open_memory


@module.rule(when=rs.startup.detached(), writes=memory, detached=True, background=True)
async def open_up(ctx: rs.RuleContext) -> None:
    """Open memory at the place that the settings name.

    The slot gets the memory object immediately; operations wait until the memory is open.
    """
    opening = open_memory(ctx.settings)
    ctx[memory] = opening

    def let_go() -> None:
        ctx[memory] = None  # the conversation goes on without memory
        opening.close()

    try:
        await opening.opened()
    except PlatformError as error:  # no rule is at fault, so this does not raise ``rs.error``
        let_go()
        ctx.log.warning("there is no long-term memory in this conversation: %s", error)
    except BaseException:
        let_go()
        raise


@module.rule(when=rs.shutdown.detached(), reads=memory, background=True)
async def close(ctx: rs.RuleContext) -> None:
    """Close memory after all writes of the conversation."""
    opened = ctx[memory]
    if opened is None:
        return
    try:
        await ctx.quiet()
        await asyncio.sleep(0)  # give the rules time to queue their last writes to slots that are saved in memory
    finally:
        await opened.close()
