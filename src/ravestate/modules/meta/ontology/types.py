"""The types of nodes, with inheritance, and the relations between them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, date, datetime
from typing import Any, Literal

from ravestate.declare.wording import short
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
    """A type of nodes: its supertype, and the kinds of its own properties. `Types` also knows inherited properties."""

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

    Every method raises `RuleError` for an undeclared type, relation or property, and for a value of a wrong kind.
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
        """Return all properties of a type as a map from names to kinds, inherited properties first."""
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
                for first, second in self.relating(relation).ends
                for source in self.subtypes(first)
                for target in self.subtypes(second)
            }
        )

    def stored(self, owner: str, values: Mapping[str, Value]) -> dict[str, Any]:
        """Return properties of a type or relation as memory stores them: dates and times become sortable texts."""
        kinds = self._kinds(owner)
        for name in values:
            if name not in kinds:
                raise RuleError(
                    f"{owner} has no {name!r}{nearest(name, kinds)} (it has {', '.join(kinds) or 'nothing'}; to add it, write "
                    f"{owner}: {{has: {{{name}: text}}}} in a file of types, and name the file in ontology.types)"
                )
        return {
            name: None if value is None else _as_stored(f"{owner}.{name}", kinds[name], value)
            for name, value in values.items()
        }

    def loaded(self, owner: str, values: Mapping[str, Any]) -> dict[str, Value]:
        """Return stored properties of a type or relation as rules see them, without missing and undeclared values."""
        return {
            name: _as_loaded(f"{owner}.{name}", kind, values[name])
            for name, kind in self._kinds(owner).items()
            if values.get(name) is not None
        }

    def check_relation(self, source: str, relation: str, target: str) -> None:
        """Check that a relation may join nodes of two types."""
        self._check(source)
        self._check(target)
        ends = self.relating(relation).ends
        if not any(self.is_a(source, first) and self.is_a(target, second) for first, second in ends):
            known = " or ".join(f"from {first} to {second}" for first, second in sorted(ends))
            raise RuleError(f"{relation} does not go from {source} to {target}, but {known}")

    def check_end(self, type: str, relation: str, *, back: bool = False) -> None:
        """Check that nodes of a type may be the source of a relation; with `back`, the target of the relation."""
        self._check(type)
        ends = {pair[1 if back else 0] for pair in self.relating(relation).ends}
        if not any(self.is_a(type, end) for end in ends):
            way = "to" if back else "from"
            raise RuleError(f"{relation} goes {way} {' or '.join(sorted(ends))}, not {way} {type}")

    def relating(self, relation: str) -> Relating:
        """Return the relation with this name."""
        found = self._relations.get(relation)
        if found is None:
            raise RuleError(
                f"there is no relation {relation!r}{nearest(relation, self._relations)} (to add it, write relations: "
                f"{{{relation}: Thing}} under a type in a file of types, and name the file in ontology.types)"
            )
        return found

    # ------------------------------------------------------------------------------- internals

    def _line(self, name: str | None) -> Iterator[str]:
        while name is not None:
            yield name
            name = self._types[name].parent

    def _inherited(self, name: str) -> dict[str, Kind]:
        return {key: kind for one in reversed(self._lines[name]) for key, kind in self._types[one].properties.items()}

    def _kinds(self, owner: str) -> Mapping[str, Kind]:
        relation = self._relations.get(owner)  # a type and a relation never have the same name
        return self.properties(owner) if relation is None else relation.properties

    def _check(self, type: str) -> None:
        if type not in self._types:
            raise RuleError(
                f"there is no type {type!r}{nearest(type, self._types)} (to add it, write {type}: {{is: Thing}} in a file "
                "of types, and name the file in the setting ontology.types)"
            )


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
    raise RuleError(f"{what} is of kind {kind}, not {short(value, 60)}: write for example {_EXAMPLES[kind]}")


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
