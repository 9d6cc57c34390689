"""Disjunctive normal form (law L5): a condition as an ordered list of conjunctions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, cast

from ravestate.declare.condition import AllOf, AnyOf, Compound, Condition, Constraint, Holds
from ravestate.declare.signal import Signal
from ravestate.errors import DeclarationError

MAX_CLAUSES = 256  # the maximum number of conjunctions in a condition; a condition with more must be a mistake

Atoms = tuple[Constraint | Holds, ...]


@dataclass(frozen=True, slots=True)
class Conjunction:
    """A conjunction: constraints on signals, and guards, which are predicates on slots."""

    constraints: tuple[Constraint, ...]
    guards: tuple[Holds, ...]


def normal_form(condition: Condition) -> tuple[Conjunction, ...]:
    """Bring a condition of any depth into disjunctive normal form, in declaration order, without duplicates.

    Raise a `DeclarationError` if a part is not a condition. Raise it also if the condition, or a part of it, has more
    than `MAX_CLAUSES` conjunctions, including duplicates.
    """
    parts = list(_inner_first(condition))
    _check(condition, parts)
    forms: dict[int, list[Atoms]] = {}
    for part in parts:
        forms[id(part)] = _expanded(part, forms)
    return tuple(
        dict.fromkeys(
            Conjunction(
                tuple(dict.fromkeys(a for a in atoms if isinstance(a, Constraint))),
                tuple(dict.fromkeys(a for a in atoms if isinstance(a, Holds))),
            )
            for atoms in forms[id(condition)]
        )
    )


def _inner_first(condition: Condition) -> Iterator[Condition]:
    """Yield the condition and each of its parts once. Each part comes after the parts inside it."""
    seen: set[int] = set()
    stack = [(condition, False)]
    while stack:
        part, done = stack.pop()
        if done:
            yield part
        elif id(part) not in seen:
            seen.add(id(part))
            stack.append((part, True))
            if isinstance(part, Compound):
                stack.extend((inner, False) for inner in part.parts)


def _check(condition: Condition, parts: list[Condition]) -> None:
    """Refuse a part that is not a condition, and refuse a condition that would have too many conjunctions."""
    counts: dict[int, int] = {}
    for part in parts:
        key = id(part)
        if isinstance(part, Compound):
            of_parts = [counts[id(inner)] for inner in part.parts]
            count = sum(of_parts) if isinstance(part, AnyOf) else math.prod(of_parts)
            if count > MAX_CLAUSES:
                whole = "condition" if part is condition else "condition has a part that"
                raise DeclarationError(
                    f"its {whole} has {_shown(count)} alternatives, more than {MAX_CLAUSES}: move a part of it to a rule "
                    "that emits a signal"
                )
            counts[key] = count
        elif isinstance(part, (Signal, Constraint, Holds)):
            counts[key] = 1
        else:
            raise DeclarationError(f"{part!r} is not a condition: combine signals with & and |")


def _shown(count: int) -> str:
    return f"{count}" if count < 10**9 else f"more than 10^{int((count.bit_length() - 1) * math.log10(2))}"


def _expanded(part: Condition, forms: dict[int, list[Atoms]]) -> list[Atoms]:
    """Return the conjunctions of a part. `forms` has the conjunctions of the parts inside this part."""
    if isinstance(part, AnyOf):
        return [atoms for inner in part.parts for atoms in forms[id(inner)]]
    if isinstance(part, Signal):
        return [(Constraint(cast("Signal[Any]", part)),)]
    if not isinstance(part, AllOf):
        return [(cast("Constraint | Holds", part),)]  # `_check` has refused any other type
    found: list[Atoms] = [()]
    for inner in part.parts:
        found = [left + right for left in found for right in forms[id(inner)]]
    return found
