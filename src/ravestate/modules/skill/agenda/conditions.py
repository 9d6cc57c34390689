"""Functions that derive a condition from another: detached, or negated."""

from __future__ import annotations

from typing import Any

import ravestate as rs
from ravestate.declare.condition import AllOf, AnyOf, Condition, Constraint, Holds


def watching(condition: Condition) -> Condition:
    """Return the condition with all its constraints detached, so that it consumes nothing."""
    match condition:
        case rs.Signal():
            return condition.max_age(None).detached()
        case Constraint():
            return condition.detached()
        case AllOf(parts):
            return AllOf(tuple(map(watching, parts)))
        case AnyOf(parts):
            return AnyOf(tuple(map(watching, parts)))
        case _:
            return condition


def negated(condition: Condition) -> Condition:
    """Return the negation of a condition that consists of ``slot.holds(...)`` alone.

    Raises:
        rs.DeclarationError: The condition contains a signal, which cannot be negated.
    """
    match condition:
        case Holds(slot, predicate):

            def otherwise(value: Any) -> bool:
                return not predicate(value)

            otherwise.__name__ = f"not_{getattr(predicate, '__name__', 'so')}"
            return slot.holds(otherwise)
        case AllOf(parts):
            return AnyOf(tuple(map(negated, parts)))
        case AnyOf(parts):
            return AllOf(tuple(map(negated, parts)))
        case _:
            raise rs.DeclarationError(
                f"unless={condition} has a signal in it: write unless=slot.holds(predicate), with a slot that "
                "keeps the signal's state"
            )
