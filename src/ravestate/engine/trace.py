"""The trace (law L25): records for the debugger, the recorder and the tests. The union `Record` lists all kinds.

The engine makes a record only while it has a tracer. The records identify a run by the number of its activation.
Events, effects and ``ctx.run`` have the run's own number, which does not depend on the tracer. `Started` has both
numbers.

Times are in seconds. The number ``clause`` is the clause's place within its rule.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Born:
    """A spike was born; ``source`` is the activation whose run raised it, or 0 if no run raised it."""

    time: float
    spike: int
    signal: str
    group: int
    parents: tuple[int, ...]
    source: int
    payload: Any


@dataclass(frozen=True, slots=True)
class Dropped:
    """A spike was withdrawn: its signal overflowed, it was wiped, or a later spike replaced it (L20, L23)."""

    time: float
    spike: int
    signal: str
    reason: str


@dataclass(frozen=True, slots=True)
class Merged:
    """The causal group ``group`` became part of the group ``into`` (L11)."""

    time: float
    group: int
    into: int


@dataclass(frozen=True, slots=True)
class Set:
    """A slot got a value; ``run`` is the activation whose run wrote it, or 0 if no run wrote it."""

    time: float
    slot: str
    value: Any
    run: int


@dataclass(frozen=True, slots=True)
class Held:
    """An activation took a spike; ``lacks`` are the signals that it still lacks (L12)."""

    time: float
    activation: int
    rule: str
    clause: int
    spike: int
    signal: str
    lacks: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GaveUp:
    """An activation gave a spike up; ``reason`` is a `LossReason`."""

    time: float
    activation: int
    rule: str
    spike: int
    signal: str
    reason: str
    by: str = ""  # the rule that consumed the spike, or resigned; empty if there is none, or if it is unknown
    run: int = 0  # the activation of the rule `by`; 0 if there is none, or if it is unknown


@dataclass(frozen=True, slots=True)
class Passed:
    """A rule did not take a spike.

    ``reason`` is a `PassReason`: the spike's ``payload`` did not fit, its cause was ``consumed``, or the rule itself
    had ``caused`` the spike.
    """

    time: float
    rule: str
    clause: int
    spike: int
    signal: str
    reason: str
    by: str = ""  # the rule that had consumed the spike's cause; empty if unknown
    run: int = 0  # the activation of the rule `by`; 0 if unknown


@dataclass(frozen=True, slots=True)
class Waits:
    """A ready activation waits for the rules ``for_``: those of rivals, and those of runs that have taken a slot (L15).

    The wait ends at ``until`` at the latest, because the patience of the rivals ends then. Without such a limit,
    ``until`` is None.
    """

    time: float
    activation: int
    rule: str
    for_: tuple[str, ...]
    until: float | None


@dataclass(frozen=True, slots=True)
class Pressed:
    """The rival ``rule`` is under pressure: the rule ``by`` waits for it (L16).

    The rival lacks the signals ``lacks``. Its patience ends at ``until``.
    """

    time: float
    rule: str
    by: str
    lacks: tuple[str, ...]
    until: float


@dataclass(frozen=True, slots=True)
class Started:
    """A rule's function starts to run (L17).

    The records number a run by its activation: ``run``. Events, effects and ``ctx.run`` number it by ``number``.
    """

    time: float
    run: int
    rule: str
    clause: int
    spikes: tuple[int, ...]
    number: int = 0  # 0 if the trace is from a release without this number


@dataclass(frozen=True, slots=True)
class Told:
    """The engine asked the run of the activation ``run`` to end; ``reason`` is a `StopReason`."""

    time: float
    run: int
    rule: str
    reason: str


@dataclass(frozen=True, slots=True)
class Settled:
    """The run of the activation ``run`` has ended; ``outcome`` is an `Outcome` (L18).

    ``fired`` says whether the run consumed its spikes.
    """

    time: float
    run: int
    rule: str
    outcome: str
    reason: str
    fired: bool
    error: BaseException | str | None = field(default=None, repr=False, compare=False)  # in a trace file: the traceback


Record = Born | Dropped | Merged | Set | Held | GaveUp | Passed | Waits | Pressed | Started | Told | Settled
Tracer = Callable[[Record], None]
