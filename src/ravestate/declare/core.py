"""What is built in (L22): the module ``core``. It brings no rules."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.declare.module import Module

__all__ = ["RuleFailure", "activity", "core", "error", "pressure", "shutdown", "startup"]


@dataclass(frozen=True, slots=True)
class RuleFailure:
    """Payload of ``rs.error``: which rule failed, and how."""

    rule: str
    exception: BaseException


core = Module("core")

startup = core.signal("startup", input=True)
"""Raised once, when a context starts."""

shutdown = core.signal("shutdown", input=True)
"""Raised once, when a context is asked to end; rules that it triggers may finish."""

error = core.signal("error", payload=RuleFailure, input=True)
"""Raised when a rule fails (L18)."""

activity = core.flag("activity", input=True, keep="latest")
"""True while some activation of a non-background rule holds a spike or runs."""

pressure = core.flag("pressure", input=True, keep="latest")
"""True while some activation is ready and kept waiting."""
