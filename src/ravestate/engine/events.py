"""Events: the reports and orders that an engine receives. The union `Event` lists all kinds. A journal keeps events for
a replay."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from ravestate.policy.policy import Policy

OutcomeKind = Literal["done", "resigned", "failed", "retired"]


@dataclass(slots=True)
class Start:
    """The context begins: ``core:startup`` occurs."""


@dataclass(slots=True)
class Stop:
    """The context is about to end: ``core:shutdown`` occurs."""


@dataclass(slots=True)
class Write:
    """A run, or code outside the rules (``run=None``), writes a slot.

    The value of a collection is a mapping of all its items. Code outside the rules may add an `origin`, which
    ``ctx.origin`` returns in every rule that the write leads to.
    """

    slot: str
    value: Any
    run: int | None = None
    origin: Any = None


@dataclass(slots=True)
class Store:
    """A run, or code outside the rules (``run=None``), stores an item in a collection."""

    slot: str
    key: str
    item: Any
    run: int | None = None


@dataclass(slots=True)
class Discard:
    """A run, or code outside the rules (``run=None``), removes an item, if the collection has it."""

    slot: str
    key: str
    run: int | None = None


@dataclass(slots=True)
class Emit:
    """A run, or code outside the rules (``run=None``), raises a signal. For `origin`, see `Write`."""

    signal: str
    payload: Any = None
    run: int | None = None
    origin: Any = None


@dataclass(slots=True)
class Wipe:
    """A run, or code outside the rules (``run=None``), withdraws a signal's live spikes and their descendants."""

    signal: str
    run: int | None = None


@dataclass(slots=True)
class Finish:
    """The function of a run has ended (L18); `reason` and `exception` say why a run resigned, retired or failed."""

    run: int
    kind: OutcomeKind
    reason: str = ""
    exception: BaseException | None = None


@dataclass(slots=True)
class AddRule:
    """The context gets a new policy, which has all rules of the present policy and at least one more."""

    policy: Policy


Event = Start | Stop | Write | Store | Discard | Emit | Wipe | Finish | AddRule
