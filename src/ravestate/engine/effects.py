"""Effects: the orders and reports of an engine to the runtime around it. A closed union of records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ravestate.declare.rule import Rule

CancelReason = Literal["interrupted", "timeout", "wiped"]


@dataclass(slots=True)
class Run:
    """Call a rule's function, and report by `Finish`.

    Attributes:
        run: The number of the run, which every event of the run carries.
        rule: The rule.
        payloads: The payload of each signal that the run holds, by qualified name.
        values: The current values of the slots that the run may read (L13), by qualified name.
    """

    run: int
    rule: Rule[Any, Any]
    payloads: Mapping[str, Any]
    values: Mapping[str, Any]


@dataclass(slots=True)
class Cancel:
    """Cancel a run: let it clean up, then report by `Finish`."""

    run: int
    reason: CancelReason


@dataclass(slots=True)
class Failed:
    """Log a rule's failure once, with its traceback."""

    rule: str
    exception: BaseException


@dataclass(slots=True)
class Spiked:
    """Report a new spike of a watched signal."""

    signal: str
    payload: Any


@dataclass(slots=True)
class Ended:
    """Report the outcome of a run, if the engine has `report_ends`. ``fired`` is false if the run resigned, or if it
    failed or was wiped before it wrote a slot."""

    run: int
    rule: str
    outcome: str
    fired: bool


Effect = Run | Cancel | Failed | Spiked | Ended
