"""Follow the user's sound on a line (microphone and loudspeaker), from the first block to the last one."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import ravestate as rs

from .names import another_speaks, spoke_up, user_speaking

if TYPE_CHECKING:
    from .opening import Conversation

DEAF = 0.25
"""With `half_duplex`, the agent stays deaf for this many seconds after its speech, because the room echoes."""
LONGEST_END = 300.0
"""After the end of a recording, the agent may continue for this many seconds."""


async def follow(ctx: rs.RuleContext, talk: Conversation) -> None:
    """Pass each block to the ear, which detects speech, and the ear's events to the rules.

    Return when the line is closed, or when the agent has finished after the end of a recording.
    """
    settings, line, ear, mouth = talk.settings, talk.line, talk.ear, talk.mouth
    spoke_at, ended_at, clipped = float("-inf"), float("inf"), False
    quiet: asyncio.Future[None] | None = None
    try:
        async for block in line.blocks():
            far = mouth.reference(len(block))
            if mouth.sounding:
                spoke_at = ctx.now
            if settings.half_duplex and ctx.now - spoke_at < DEAF:
                block = bytes(len(block))
            for event in ear.feed(block, ctx.now, far, agent_speaks=mouth.speaking):
                if event == "articulate":
                    ctx.emit(spoke_up)
                elif event == "another":
                    ctx.emit(another_speaks, ear.parted)
                else:
                    ctx[user_speaking] = event == "onset"
            if ear.clipped and not clipped:
                clipped = True
                ctx.log.warning("the microphone's sound is too loud and is clipped: lower its level")
            if line.ended:
                ended_at = min(ended_at, ctx.now)
                if quiet is None and ctx.now - ended_at > settings.longest_pause + 0.5:
                    quiet = asyncio.ensure_future(ctx.quiet())
                if (quiet is not None and quiet.done()) or ctx.now - ended_at > LONGEST_END:
                    return
    finally:
        if quiet is not None:
            quiet.cancel()
