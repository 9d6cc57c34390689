"""What a rule function may return (or raise) besides nothing (L18)."""

from __future__ import annotations

from ravestate.errors import RavestateError

__all__ = ["Resign", "Retire"]


class Resign(RavestateError):
    """The rule does not apply after all: the next best rule is asked.

    ``return rs.Resign("reason")`` or ``raise rs.Resign("reason")``. Only before the rule has written a slot.
    """

    def __init__(self, reason: str = "") -> None:
        super().__init__(reason)
        self.reason = reason


class Retire(RavestateError):
    """The rule is done for good: it leaves this context (others that share the policy keep it)."""

    def __init__(self, reason: str = "") -> None:
        super().__init__(reason)
        self.reason = reason
