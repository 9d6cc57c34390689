"""Fills a pause: "Let me think..." when an answer takes its time."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent

__all__ = ["module"]

module = rs.Module("fillers", requires=[rawio, idle, verbaliser])


def _silent(speaking: bool) -> bool:
    return not speaking


@module.rule(when=idle.impatient & rawio.speaking.holds(_silent), writes=verbaliser.intent)
async def fill_the_pause(ctx: rs.RuleContext) -> None:
    """Something is kept waiting, and nothing is being said."""
    ctx[verbaliser.intent] = Intent("filler", package=__package__)
