"""The records in memory: nodes with properties, and relations between nodes."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date, datetime
from types import MappingProxyType
from typing import Any

Value = str | int | float | bool | date | datetime | None
"""A property's value. None stands for a property without a value."""


_lock = threading.Lock()
_last = 0


def _next_id(type: str) -> str:
    """Return a new id. Among nodes of one type, sorting by id sorts by age."""
    global _last  # all threads and contexts of the process share one series of ids
    with _lock:
        _last = max(_last + 1, time.time_ns() // 1000)
        return f"{type}:{_last:014x}{secrets.token_hex(4)}"


@dataclass(frozen=True, slots=True)
class Node:
    """A thing that the agent knows: a type and properties. It is immutable; `with_properties` returns a changed copy.

    A new node already has its id. So a rule can save it and add relations to it without waiting for the memory's
    answer.

    Args:
        type: The name of the node's type: ``Person``.
        properties: Name of a property → its value. Saving the node removes a property that is None.
        id: The node's id: its type, a colon and a hexadecimal number. Default: a new id. Newer ids have greater
            numbers.

    Example:
        >>> ada = Node("Person", {"name": "Ada"})
        >>> older = ada.with_properties(age=36)
        >>> older["name"], older.get("age"), ada.get("age"), older.id == ada.id
        ('Ada', 36, None, True)
    """

    type: str
    properties: Mapping[str, Value] = field(default_factory=dict[str, Value])
    id: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "properties", MappingProxyType(dict(self.properties)))
        if not self.id:
            object.__setattr__(self, "id", _next_id(self.type))

    def with_properties(self, **properties: Value) -> Node:
        """Return a copy of the node with new values for some properties. To remove a property, pass None, and save."""
        return Node(self.type, {**self.properties, **properties}, self.id)

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a property, or `default` if it has no value."""
        value = self.properties.get(name)
        return default if value is None else value

    def __getitem__(self, name: str) -> Any:
        """Return the value of a property; raise `KeyError` if it has no value."""
        value = self.properties.get(name)
        if value is None:
            known = [key for key, value in self.properties.items() if value is not None]
            raise KeyError(f"{self.id} has no {name}; it has {', '.join(known) or 'nothing'}")
        return value

    def __repr__(self) -> str:
        return f"Node({self.type!r}, {dict(self.properties)!r}, {self.id!r})"

    def __hash__(self) -> int:
        return hash(self.id)

    def __reduce__(self) -> tuple[Any, ...]:
        return Node, (self.type, dict(self.properties), self.id)


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation from `source` to `target`, such as ``lives_in``, with properties of its own."""

    source: Node
    name: str
    target: Node
    properties: Mapping[str, Value] = field(default_factory=dict[str, Value])

    def __post_init__(self) -> None:
        object.__setattr__(self, "properties", MappingProxyType(dict(self.properties)))

    def __hash__(self) -> int:
        return hash((self.source.id, self.name, self.target.id))

    def __reduce__(self) -> tuple[Any, ...]:
        return Relation, (self.source, self.name, self.target, dict(self.properties))
