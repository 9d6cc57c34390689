"""Disjunctive normal form (L5): a condition as an ordered list of conjunctions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

from ravestate.declare.condition import AllOf, AnyOf, Condition, Constraint, Holds
from ravestate.declare.signal import Signal
from ravestate.errors import DeclarationError

__all__ = ["MAX_CLAUSES", "Conjunction", "normal_form"]

MAX_CLAUSES = 256
"""A condition with more conjunctions than this is a mistake of the designer's, and is refused."""


@dataclass(frozen=True, slots=True)
class Conjunction:
    """One clause: constraints that want spikes, and predicates on slots that gate it."""

    constraints: tuple[Constraint, ...]
    guards: tuple[Holds, ...]


def normal_form(condition: Condition) -> tuple[Conjunction, ...]:
    """Bring a condition into disjunctive normal form, in declaration order, without doubles.

    Raises:
        DeclarationError: More than `MAX_CLAUSES` conjunctions.
    """
    return tuple(
        dict.fromkeys(
            Conjunction(
                tuple(dict.fromkeys(a for a in atoms if isinstance(a, Constraint))),
                tuple(dict.fromkeys(a for a in atoms if isinstance(a, Holds))),
            )
            for atoms in _expand(condition)
        )
    )


def _expand(condition: Condition) -> list[tuple[Constraint | Holds, ...]]:
    if isinstance(condition, Signal):
        return [(Constraint(cast("Signal[Any]", condition)),)]
    if isinstance(condition, (Constraint, Holds)):
        return [(condition,)]
    if isinstance(condition, AnyOf):
        found = [atoms for part in condition.parts for atoms in _expand(part)]
    elif isinstance(condition, AllOf):
        found: list[tuple[Constraint | Holds, ...]] = [()]
        for part in condition.parts:
            right = _expand(part)
            _check(len(found) * len(right))
            found = [a + b for a in found for b in right]
    else:
        raise DeclarationError(f"{condition!r} is no condition: combine signals with & and |")
    _check(len(found))
    return found


def _check(count: int) -> None:
    if count > MAX_CLAUSES:
        raise DeclarationError(
            f"its condition has {count} alternatives, more than {MAX_CLAUSES}: raise a signal of its own "
            "for a part of it"
        )
