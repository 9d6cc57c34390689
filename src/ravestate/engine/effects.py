"""Effects: the orders and reports of an engine to the runtime around it. The union `Effect` lists all kinds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from ravestate.declare.rule import Rule

CancelReason = Literal["interrupted", "timeout", "wiped"]


@dataclass(slots=True, init=False)
class Run:
    """An order to call a rule's function, and to report its end by the event `Finish`.

    Attributes:
        run: The number of the run, which every event of the run carries. Runs are numbered in the order of their start.
        rule: The rule whose function to call.
        payloads: Key: the qualified name of a signal whose spike the run holds; value: the spike's payload.
        values: Key: the qualified name of a slot that the run may read; value: the slot's value when the run
            starts (law L13).
        origin: The object that came from outside with the event that led to the run; None if there was no object.
    """

    run: int
    rule: Rule[Any, Any]
    payloads: Mapping[str, Any]
    values: dict[str, Any]
    origin: Any

    def __init__(
        self,
        run: int,
        rule: Rule[Any, Any],
        payloads: Mapping[str, Any],
        values: dict[str, Any],
        origin: Any = None,
    ) -> None:
        self.run = run
        self.rule = rule
        self.payloads = payloads
        self.values = values
        self.origin = origin


@dataclass(slots=True)
class Cancel:
    """An order to cancel a run: let its function clean up, then report its end by the event `Finish`."""

    run: int
    reason: CancelReason


@dataclass(slots=True)
class Failed:
    """An order to log, once, a failure of a rule or of a predicate in its conditions."""

    rule: str
    exception: Any  # a BaseException; mypyc 2.4 cannot read this name in a dataclass


@dataclass(slots=True, init=False)
class Spiked:
    """A report of a new spike of a signal that the runtime watches (`Engine.watched`)."""

    signal: str
    payload: Any

    def __init__(self, signal: str, payload: Any) -> None:
        self.signal = signal
        self.payload = payload


@dataclass(slots=True)
class Ended:
    """A report of the outcome of a run, if the engine has `report_ends`.

    ``fired`` says whether the run consumed its spikes for the slots that its rule writes. It is false if the run
    resigned, failed, or lost its spike by a `Wipe`, before it wrote a slot. An interrupted run has fired, even if it
    resigned or failed afterwards.
    """

    run: int
    rule: str
    outcome: str
    fired: bool


Effect = Run | Cancel | Failed | Spiked | Ended
