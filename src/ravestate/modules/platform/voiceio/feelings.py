"""Make the agent's feelings audible in its voice, if the agent has the module `emotion`."""

from __future__ import annotations

import ravestate as rs

from .manner import FEELINGS, Prosody
from .names import module, prosody

LASTS = 15.0
"""A feeling is audible for this many seconds."""


def add_feelings(ctx: rs.RuleContext) -> None:
    """Add the rule that makes the agent's feelings audible, if the agent has the module `emotion`."""
    if "emotion:felt" not in ctx.policy.slots or "voiceio-feelings:feel" in ctx.policy.rules:
        return
    from ravestate.modules import emotion

    extra = rs.Module("voiceio-feelings", requires=[module, emotion])

    @extra.rule(
        when=emotion.felt.changed.max_age(None).detached(),
        writes=prosody,
        until=emotion.felt.changed,
        background=True,
    )
    async def feel(ctx: rs.RuleContext) -> None:
        """Speak for a while in the manner of the agent's new feeling."""
        ctx[prosody] = FEELINGS.get(ctx.payload(emotion.felt.changed) or "", Prosody())
        await ctx.sleep(LASTS)
        ctx[prosody] = Prosody()

    ctx.add_rule(feel)
