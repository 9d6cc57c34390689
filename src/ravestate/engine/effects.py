"""What an engine asks of the shell around it. A closed union of records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ravestate.declare.rule import Rule

__all__ = ["Cancel", "CancelReason", "Effect", "Ended", "Failed", "Run", "Spiked"]

CancelReason = Literal["interrupted", "timeout", "wiped"]


@dataclass(slots=True)
class Run:
    """Call a rule's function, and report by `Finish`.

    Attributes:
        run: The number of the run, to be given with everything it does.
        rule: The rule.
        payloads: What it may ask for: the payload of each signal it holds, by qualified name.
        values: The slots that it may read as they stand now (L13), by qualified name.
    """

    run: int
    rule: Rule[Any, Any]
    payloads: Mapping[str, Any]
    values: Mapping[str, Any]


@dataclass(slots=True)
class Cancel:
    """End a run: let it clean up, then report by `Finish`."""

    run: int
    reason: CancelReason


@dataclass(slots=True)
class Failed:
    """A rule failed: log it, once, with its traceback."""

    rule: str
    exception: BaseException


@dataclass(slots=True)
class Spiked:
    """A spike of a watched signal was born."""

    signal: str
    payload: Any


@dataclass(slots=True)
class Ended:
    """A run has been settled; ``fired`` unless it resigned, or failed before it had written. Only on request."""

    run: int
    rule: str
    outcome: str
    fired: bool


Effect = Run | Cancel | Failed | Spiked | Ended
