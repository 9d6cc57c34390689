"""The outcomes that a rule function may return or raise (law L18)."""

from __future__ import annotations

from ravestate.errors import RavestateError


class Resign(RavestateError):
    """An outcome: the rule does not apply after all, and the next best rule may run instead.

    Write ``return rs.Resign("reason")`` or ``raise rs.Resign("reason")``. To resign after writing a slot is an error.
    The trace shows the reason.
    """

    def __init__(self, reason: str = "") -> None:
        super().__init__(reason)
        self.reason = reason


class Retire(RavestateError):
    """An outcome: the rule leaves this context for good. Other contexts of the same policy keep the rule.

    The trace shows the reason.
    """

    def __init__(self, reason: str = "") -> None:
        super().__init__(reason)
        self.reason = reason
