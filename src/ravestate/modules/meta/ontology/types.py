"""The types of nodes, with inheritance, and the relations between them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, date, datetime
from typing import Any, Literal

from ravestate.errors import RuleError, nearest

from .node import Value

Kind = Literal["text", "integer", "number", "yes/no", "date", "time"]
"""The kind of a property's values."""

KINDS: tuple[Kind, ...] = ("text", "integer", "number", "yes/no", "date", "time")

_EXAMPLES: dict[Kind, str] = {
    "text": '"Ada"',
    "integer": "36, between -2^63 and 2^63",
    "number": "1.5",
    "yes/no": "True",
    "date": "datetime.date(1815, 12, 10)",
    "time": "datetime.now(UTC), with a time zone",
}


@dataclass(frozen=True, slots=True)
class Type:
    """A type of nodes: its supertype, and the kinds of its own properties; `Types` has the inherited properties."""

    name: str
    parent: str | None = None
    properties: Mapping[str, Kind] = field(default_factory=dict[str, Kind])


@dataclass(frozen=True, slots=True)
class Relating:
    """A kind of relation: its pairs of a source type and a target type, and the kinds of its properties."""

    name: str
    ends: frozenset[tuple[str, str]]
    properties: Mapping[str, Kind] = field(default_factory=dict[str, Kind])


class Types:
    """All declared types and relations, with checks of values. ``read_types`` reads them from files.

    Every method raises `RuleError` for an undeclared type, relation or property, and for a value of another kind.
    """

    def __init__(self, types: Mapping[str, Type], relations: Mapping[str, Relating]) -> None:
        """Take valid types and relations: all parents and ends exist, and no type is its own ancestor."""
        self._types = dict(types)
        self._relations = dict(relations)
        self._lines = {name: tuple(self._line(name)) for name in self._types}
        self._properties = {name: self._inherited(name) for name in self._types}

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of all types, parents first."""
        return iter(sorted(self._types, key=lambda name: len(self._lines[name])))

    def __contains__(self, name: object) -> bool:
        """Return whether there is a type with this name."""
        return name in self._types

    @property
    def relations(self) -> Mapping[str, Relating]:
        """Name of a relation → the relation."""
        return self._relations

    def properties(self, type: str) -> Mapping[str, Kind]:
        """Return name → kind for all properties of a type, inherited properties first."""
        self._check(type)
        return self._properties[type]

    def subtypes(self, type: str) -> tuple[str, ...]:
        """Return the names of a type and of all its subtypes."""
        self._check(type)
        return tuple(name for name in self if type in self._lines[name])

    def is_a(self, type: str, other: str) -> bool:
        """Return whether a type is `other` or a subtype of it."""
        self._check(type)
        self._check(other)
        return other in self._lines[type]

    def pairs(self, relation: str) -> list[tuple[str, str]]:
        """Return all pairs (source type, target type) that a relation may join, including subtypes, sorted."""
        return sorted(
            {
                (source, target)
                for first, second in self._relations[relation].ends
                for source in self.subtypes(first)
                for target in self.subtypes(second)
            }
        )

    def stored(self, type: str, values: Mapping[str, Value]) -> dict[str, Any]:
        """Return a node's properties as memory stores them: dates and times become texts that sort by time."""
        return _stored(type, self.properties(type), values)

    def loaded(self, type: str, values: Mapping[str, Any]) -> dict[str, Value]:
        """Return a node's stored properties as rules see them, without missing and undeclared ones."""
        return _loaded(type, self._properties[type], values)

    def check_relation(self, source: str, relation: str, target: str) -> None:
        """Check that a relation may join nodes of two types."""
        self._check(source)
        self._check(target)
        ends = self.relating(relation).ends
        if not any(self.is_a(source, first) and self.is_a(target, second) for first, second in ends):
            known = " or ".join(f"from {first} to {second}" for first, second in sorted(ends))
            raise RuleError(f"{relation} does not go from {source} to {target}, but {known}")

    def check_end(self, type: str, relation: str, *, back: bool = False) -> None:
        """Check that nodes of a type may be the source of a relation; with `back`, its target."""
        self._check(type)
        ends = {pair[1 if back else 0] for pair in self.relating(relation).ends}
        if not any(self.is_a(type, end) for end in ends):
            raise RuleError(
                f"{relation} goes {'to' if back else 'from'} {' or '.join(sorted(ends))}, not {'to' if back else 'from'} {type}"
            )

    def relating(self, relation: str) -> Relating:
        """Return the relation with this name."""
        found = self._relations.get(relation)
        if found is None:
            raise RuleError(
                f"there is no relation {relation!r}{nearest(relation, self._relations)} (to add it, write under a type in "
                f"a file of your own, setting ontology.types: relations: {{{relation}: Thing}})"
            )
        return found

    def stored_of(self, relation: str, values: Mapping[str, Value]) -> dict[str, Any]:
        """Return a relation's properties as memory stores them."""
        return _stored(relation, self.relating(relation).properties, values)

    def loaded_of(self, relation: str, values: Mapping[str, Any]) -> dict[str, Value]:
        """Return a relation's stored properties as rules see them."""
        return _loaded(relation, self.relating(relation).properties, values)

    # ------------------------------------------------------------------------------- internals

    def _line(self, name: str | None) -> Iterator[str]:
        while name is not None:
            yield name
            name = self._types[name].parent

    def _inherited(self, name: str) -> dict[str, Kind]:
        found: dict[str, Kind] = {}
        for ancestor in reversed(self._lines[name]):
            found.update(self._types[ancestor].properties)
        return found

    def _check(self, type: str) -> None:
        if type not in self._types:
            raise RuleError(
                f"there is no type {type!r}{nearest(type, self._types)} (to add it, write in a file of your own, setting "
                f"ontology.types: {type}: {{is: Thing}})"
            )


def _stored(owner: str, kinds: Mapping[str, Kind], values: Mapping[str, Value]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        if name not in kinds:
            raise RuleError(
                f"{owner} has no {name!r}{nearest(name, kinds)} (it has {', '.join(kinds) or 'nothing'}; to add it, write "
                f"in a file of your own, setting ontology.types: {owner}: {{has: {{{name}: text}}}})"
            )
        found[name] = None if value is None else _as_stored(f"{owner}.{name}", kinds[name], value)
    return found


def _as_stored(what: str, kind: Kind, value: Value) -> Any:
    if kind == "text" and isinstance(value, str):
        if any("\ud800" <= letter <= "\udfff" for letter in value):
            raise RuleError(f"{what}: {value!r} has surrogates, which cannot be stored: remove them")
        return value
    if kind == "yes/no" and isinstance(value, bool):
        return value
    if isinstance(value, int) and not isinstance(value, bool):
        if kind == "integer" and -(2**63) <= value < 2**63:
            return value
        if kind == "number" and abs(value) <= 2**53:
            return float(value)
    if kind == "number" and isinstance(value, float) and math.isfinite(value):
        return value
    if kind == "time" and isinstance(value, datetime) and value.tzinfo is not None:
        try:
            return value.astimezone(UTC).isoformat(timespec="microseconds")
        except OverflowError:  # the time is in the first or last hours that the calendar can express
            pass
    if kind == "date" and isinstance(value, date) and not isinstance(value, datetime):
        return value.isoformat()
    shown = repr(value)
    shown = shown if len(shown) <= 60 else shown[:57] + "..."
    raise RuleError(f"{what} is of kind {kind}, not {shown}: write for example {_EXAMPLES[kind]}")


def _loaded(owner: str, kinds: Mapping[str, Kind], values: Mapping[str, Any]) -> dict[str, Value]:
    return {
        name: _as_loaded(f"{owner}.{name}", kind, values[name])
        for name, kind in kinds.items()
        if values.get(name) is not None
    }


def _as_loaded(what: str, kind: Kind, value: Any) -> Value:
    try:
        if kind == "date":
            return date.fromisoformat(value)
        if kind == "time":
            return datetime.fromisoformat(value)
        if kind == "number":
            return float(value)
    except (TypeError, ValueError):
        raise RuleError(f"memory has {what} = {value!r}, which is not a valid {kind}: set it again") from None
    return value
