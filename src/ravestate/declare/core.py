"""The built-in signals and flags (law L22): the module ``core``, which has no rules."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.declare.module import Module


@dataclass(frozen=True, slots=True)
class RuleFailure:
    """The payload of ``rs.error``: the name of the rule that failed, and the exception."""

    rule: str
    exception: BaseException


core = Module("core")

startup = core.signal("startup", input=True)
"""Raised once, when a context starts."""

shutdown = core.signal("shutdown", input=True)
"""Raised once, when a context is about to end. The context waits a few seconds for rules that react to this signal."""

error = core.signal("error", payload=RuleFailure, input=True)
"""Raised when a rule (L18) or a predicate of its condition fails.

If this signal leads to a run, directly or through other runs, and that run fails, the signal is not raised again. Each
predicate raises it at most once.
"""

activity = core.flag("activity", input=True, keep="latest")
"""True while some activation of a foreground rule holds a spike or runs.

An activation counts neither for this flag nor for `pressure` if its condition uses one of these two flags.
"""

pressure = core.flag("pressure", input=True, keep="latest")
"""True while some ready activation waits because of other rules."""
