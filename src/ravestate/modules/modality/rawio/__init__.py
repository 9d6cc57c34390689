"""Raw text in and out, whatever the platform."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import ravestate as rs

if TYPE_CHECKING:
    from ravestate.runtime.context import Context

__all__ = ["input", "module", "output", "picture", "piece", "say", "speaking", "typing"]

module = rs.Module("rawio")

input = module.slot("input", "", type=str, always=True, input=True)
"""What the user said last. Each utterance signals, also one that was said before."""

output = module.slot("output", "", type=str, always=True)
"""What the agent says. Each write is one whole utterance."""

piece = module.signal("piece", payload=str)
"""A piece of an utterance that is still being made, for platforms that show it as it grows. The whole utterance is
written to `output` at its end."""

speaking = module.flag("speaking")
"""Whether an utterance is being made, piece by piece."""

typing = module.signal("typing", input=True, keep="latest")
"""The user has pressed a key: a line is being written. Platforms that notice it say so, with each key or now and then."""

picture: rs.Slot[Any] = module.slot("picture", None, always=True, input=True)
"""The picture that the user showed last: encoded bytes (JPEG, PNG) or a path."""


def say(context: Context, text: str) -> None:
    """Say something to an agent from outside: as if its user had typed `text`. From any thread."""
    context.put(input, text)
