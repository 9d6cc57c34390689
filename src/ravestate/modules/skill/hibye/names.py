"""Greets and bids farewell: when users come and go, and when they say hello or goodbye."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio, verbaliser

module = rs.Module("hibye", requires=[rawio, interloc, verbaliser])

parted: rs.Slot[float | None] = module.slot("parted", None)
"""When the agent said goodbye last, in seconds since the context began."""
