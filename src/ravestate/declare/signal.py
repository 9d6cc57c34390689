"""A signal: a named kind of event (law L1)."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Generic, Literal, TypedDict, TypeVar

from ravestate.declare.condition import Condition, Constraint, Predicate
from ravestate.declare.settings import Number

T = TypeVar("T")

Keep = Literal["all", "latest"]
"""The effect of a new spike on the older live spikes of its signal: ``"all"`` keeps them, up to a limit. ``"latest"``
withdraws them (L20, L23). A spike is live while a rule holds it or may still look at it."""

DEFAULT_LIMIT = 100_000  # the default of a signal's `limit`: its maximum number of live spikes


class SignalOptions(TypedDict, total=False):
    """The options of a signal. A slot gives its options to each of its signals.

    Attributes:
        input: Whether the signal is an input, although a rule raises it too: the rules expect it from outside at any
            time (L8). A signal that no rule raises is always an input.
        keep: ``"all"`` or ``"latest"``. With ``"latest"``, a new spike withdraws the signal's older spikes (L20).
        limit: The maximum number of live spikes, 100,000 by default. A further spike drops the oldest spike (L23).
    """

    input: bool
    keep: Keep
    limit: int


@dataclass(slots=True, eq=False, repr=False)
class Signal(Condition, Generic[T]):
    """A named kind of event, made by ``module.signal(...)``. ``Signal[T]`` carries a payload of type T.

    Attributes:
        name: The qualified name, ``module:name``.
        payload: The payload's type; None if there is no payload. It is also None for the signals of a slot; their
            payloads depend on the kind of slot: see `Slot`, `Flag` and `Collection`.
        input, keep, limit: As for `SignalOptions`.
        origin: The place of the declaration, ``file:line``.
    """

    name: str
    payload: object
    _: KW_ONLY
    origin: str
    input: bool = False
    keep: Keep = "all"
    limit: int = DEFAULT_LIMIT

    def min_age(self, seconds: Number) -> Constraint:
        """Return a constraint on this signal: see `Constraint.min_age`."""
        return Constraint(self).min_age(seconds)

    def max_age(self, seconds: Number | None) -> Constraint:
        """Return a constraint on this signal: see `Constraint.max_age`."""
        return Constraint(self).max_age(seconds)

    def detached(self) -> Constraint:
        """Return a constraint on this signal: see `Constraint.detached`."""
        return Constraint(self).detached()

    def where(self, predicate: Predicate) -> Constraint:
        """Return a constraint on this signal: see `Constraint.where`."""
        return Constraint(self).where(predicate)

    def __repr__(self) -> str:
        return self.name
