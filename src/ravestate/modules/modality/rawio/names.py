"""The module rawio: its slots and signals."""

from __future__ import annotations

from typing import Any

import ravestate as rs

module = rs.Module("rawio")

input = module.slot("input", "", type=str, always=True, input=True)
"""The words that the user said last. Each utterance signals, even if it equals the one before."""

output = module.slot("output", "", type=str, always=True)
"""The words of the agent. Each write is one whole utterance."""

piece = module.signal("piece", payload=str)
"""A piece of an utterance that is still being made, for platforms that show it as it grows. The rule that makes the
utterance writes it to `output` at its end."""

speaking = module.flag("speaking")
"""Whether an utterance is being made piece by piece."""

typing = module.signal("typing", input=True, keep="latest")
"""The user is writing a line. A platform that notices emits this with each key, or now and then."""

picture: rs.Slot[Any] = module.slot("picture", None, always=True, input=True)
"""The picture that the user showed last: encoded bytes (JPEG, PNG) or a path."""
