"""A signal: a named kind of event (L1)."""

from __future__ import annotations

from typing import Generic, Literal, TypeVar

from ravestate.declare.condition import Condition, Constraint, Predicate
from ravestate.declare.settings import Number

__all__ = ["DEFAULT_LIMIT", "Keep", "Signal"]

T = TypeVar("T")

Keep = Literal["all", "latest"]
"""What becomes of older live spikes when a new one is born: kept up to a limit, or withdrawn (L20, L23)."""

DEFAULT_LIMIT = 100_000
"""Live spikes of one signal beyond which the oldest is dropped, counted and traced (L23)."""


class Signal(Condition, Generic[T]):
    """A named kind of event; ``Signal[T]`` carries a payload of type T. Made by ``module.signal(...)``.

    Attributes:
        name: The qualified name, ``module:name``.
        payload: The payload's type; None if it carries none, and for a slot's own, which carries what the slot takes.
        input: Whether it may come from outside although a rule raises it too (L8).
        keep: ``"all"`` or ``"latest"``.
        limit: The greatest number of live spikes.
        origin: Where it was declared, ``file:line``.
    """

    __slots__ = ("input", "keep", "limit", "name", "origin", "payload")

    def __init__(
        self, name: str, payload: object, *, input: bool, keep: Keep, limit: int, origin: str
    ) -> None:
        self.name = name
        self.payload = payload
        self.input = input
        self.keep: Keep = keep
        self.limit = limit
        self.origin = origin

    def min_age(self, seconds: Number) -> Constraint:
        """Constrain the signal: see `Constraint.min_age`."""
        return Constraint(self).min_age(seconds)

    def max_age(self, seconds: Number | None) -> Constraint:
        """Constrain the signal: see `Constraint.max_age`."""
        return Constraint(self).max_age(seconds)

    def detached(self) -> Constraint:
        """Constrain the signal: see `Constraint.detached`."""
        return Constraint(self).detached()

    def where(self, predicate: Predicate) -> Constraint:
        """Constrain the signal: see `Constraint.where`."""
        return Constraint(self).where(predicate)

    def __repr__(self) -> str:
        return self.name
