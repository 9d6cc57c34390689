"""Events: the inputs of an engine. A closed union of records; the journal keeps them, and a replay feeds them again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from ravestate.policy.policy import Policy

OutcomeKind = Literal["done", "resigned", "failed", "retired"]


@dataclass(slots=True)
class Start:
    """Begin the context: ``core:startup`` occurs."""


@dataclass(slots=True)
class Stop:
    """Ask the context to end: ``core:shutdown`` occurs."""


@dataclass(slots=True)
class Write:
    """Write a slot, by a run or (``run=None``) from outside. The value of a collection is a whole mapping."""

    slot: str
    value: Any
    run: int | None = None


@dataclass(slots=True)
class Store:
    """Store an item in a collection."""

    slot: str
    key: str
    item: Any
    run: int | None = None


@dataclass(slots=True)
class Discard:
    """Remove an item from a collection, if it is there."""

    slot: str
    key: str
    run: int | None = None


@dataclass(slots=True)
class Emit:
    """Raise a signal, by a run or from outside."""

    signal: str
    payload: Any = None
    run: int | None = None


@dataclass(slots=True)
class Wipe:
    """Withdraw the live spikes of a signal and all their descendants (L20)."""

    signal: str
    run: int | None = None


@dataclass(slots=True)
class Finish:
    """Report the end of a run (L18)."""

    run: int
    kind: OutcomeKind
    reason: str = ""
    exception: BaseException | None = None


@dataclass(slots=True)
class AddRule:
    """Replace the policy by one that has more rules."""

    policy: Policy


Event = Start | Stop | Write | Store | Discard | Emit | Wipe | Finish | AddRule
