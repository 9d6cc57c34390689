"""The trace (L25): a closed union of records for the debugger, the recorder and the tests.

The engine makes a record only while it has a tracer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True)
class Born:
    """A spike was born; ``source`` is the run that raised it, 0 from outside."""

    time: float
    spike: int
    signal: str
    group: int
    parents: tuple[int, ...]
    source: int
    payload: Any


@dataclass(frozen=True, slots=True)
class Dropped:
    """A spike was withdrawn, by overflow, a wipe, or a later spike (L20, L23)."""

    time: float
    spike: int
    signal: str
    reason: str


@dataclass(frozen=True, slots=True)
class Merged:
    """One causal group became part of another (L11)."""

    time: float
    group: int
    into: int


@dataclass(frozen=True, slots=True)
class Set:
    """A slot got a value."""

    time: float
    slot: str
    value: Any
    run: int


@dataclass(frozen=True, slots=True)
class Held:
    """An activation acquired a spike (L12)."""

    time: float
    activation: int
    rule: str
    clause: int
    spike: int
    signal: str
    lacks: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class GaveUp:
    """An activation gave a spike up: ``age``, ``consumed``, ``resigned``, ``eliminated``, ``withdrawn``, ``retired``."""

    time: float
    activation: int
    rule: str
    spike: int
    signal: str
    reason: str
    by: str = ""  # the rule that consumed the spike, or resigned
    run: int = 0  # the number of its run; 0 if there is none, or it is unknown


@dataclass(frozen=True, slots=True)
class Passed:
    """A rule did not take a spike.

    Its ``payload`` did not fit, its cause was ``consumed``, or the rule itself had ``caused`` it.
    """

    time: float
    rule: str
    clause: int
    spike: int
    signal: str
    reason: str
    by: str = ""  # the rule that had consumed its cause, if known
    run: int = 0  # the number of its run; 0 if there is none, or it is unknown


@dataclass(frozen=True, slots=True)
class Waits:
    """A ready activation waits for rivals, or for runs that hold a slot (L15)."""

    time: float
    activation: int
    rule: str
    for_: tuple[str, ...]
    until: float | None


@dataclass(frozen=True, slots=True)
class Pressed:
    """A rival is under pressure until its patience runs out (L16)."""

    time: float
    rule: str
    by: str
    lacks: tuple[str, ...]
    until: float


@dataclass(frozen=True, slots=True)
class Started:
    """A rule function runs (L17)."""

    time: float
    run: int
    rule: str
    clause: int
    spikes: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Told:
    """The engine asked a run to end: ``interrupted``, ``timeout``, ``wiped``."""

    time: float
    run: int
    rule: str
    reason: str


@dataclass(frozen=True, slots=True)
class Settled:
    """A run has ended (L18): ``done``, ``resigned``, ``failed``, ``retired``, ``interrupted``, ``wiped``."""

    time: float
    run: int
    rule: str
    outcome: str
    reason: str
    fired: bool
    error: BaseException | str | None = field(default=None, repr=False, compare=False)  # in a trace file: the traceback


Record = Born | Dropped | Merged | Set | Held | GaveUp | Passed | Waits | Pressed | Started | Told | Settled
Tracer = Callable[[Record], None]
