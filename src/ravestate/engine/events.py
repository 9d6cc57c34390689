"""What an engine is told. A closed union of records; the journal keeps them, replay feeds them again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from ravestate.policy.policy import Policy

__all__ = [
    "AddRule",
    "Discard",
    "Emit",
    "Event",
    "Finish",
    "OutcomeKind",
    "Start",
    "Stop",
    "Store",
    "Wipe",
    "Write",
]

OutcomeKind = Literal["done", "resigned", "failed", "retired"]


@dataclass(slots=True)
class Start:
    """The context begins: ``core:startup``."""


@dataclass(slots=True)
class Stop:
    """The context is asked to end: ``core:shutdown``."""


@dataclass(slots=True)
class Write:
    """A slot gets a value; by a run, or (``run=None``) from outside. A collection gets a whole mapping."""

    slot: str
    value: Any
    run: int | None = None


@dataclass(slots=True)
class Store:
    """An item is set in a collection."""

    slot: str
    key: str
    item: Any
    run: int | None = None


@dataclass(slots=True)
class Discard:
    """An item is removed from a collection; nothing happens if it is not there."""

    slot: str
    key: str
    run: int | None = None


@dataclass(slots=True)
class Emit:
    """A signal occurs; by a run, or from outside."""

    signal: str
    payload: Any = None
    run: int | None = None


@dataclass(slots=True)
class Wipe:
    """The live spikes of a signal and all their descendants are withdrawn (L20)."""

    signal: str
    run: int | None = None


@dataclass(slots=True)
class Finish:
    """A run has ended (L18)."""

    run: int
    kind: OutcomeKind
    reason: str = ""
    exception: BaseException | None = None


@dataclass(slots=True)
class AddRule:
    """The policy is replaced by one with a rule more."""

    policy: Policy


Event = Start | Stop | Write | Store | Discard | Emit | Wipe | Finish | AddRule
