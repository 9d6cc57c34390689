"""Documents: the content of memory as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import date, datetime
from typing import Any, cast

from ravestate.errors import RuleError

from .node import Node, Relation, Value
from .store import FORMAT
from .types import Kind, Types


def write_document(nodes: Iterable[Node], relations: Iterable[Relation]) -> dict[str, Any]:
    """Return a document of these nodes and relations; dates and times become ISO 8601 texts."""
    return {
        "format": FORMAT,
        "nodes": [{"id": node.id, "type": node.type, "properties": _plain(node.properties)} for node in nodes],
        "relations": [
            {"from": one.source.id, "relation": one.name, "to": one.target.id, "properties": _plain(one.properties)}
            for one in relations
        ],
    }


def read_document(document: Mapping[str, Any], types: Types) -> tuple[list[Node], list[Relation]]:
    """Return the nodes and relations of a document.

    Raises:
        RuleError: The document is invalid; the message names the first wrong entry.
    """
    if not isinstance(document, Mapping) or document.get("format") != FORMAT:  # pyright: ignore[reportUnnecessaryIsInstance]  # a file may hold anything
        raise RuleError(f"this is not an exported memory of format {FORMAT}: write one with ravestate memory export")
    nodes: dict[str, Node] = {}
    for entry in _entries(document, "nodes"):
        type, id = _text(entry, "type"), _text(entry, "id")
        nodes[id] = Node(type, _values(types.properties(type), entry), id)
    relations: list[Relation] = []
    for entry in _entries(document, "relations"):
        ends = [nodes.get(_text(entry, key)) for key in ("from", "to")]
        if ends[0] is None or ends[1] is None:
            raise RuleError(f"the relation {entry} is between nodes that the document does not have")
        name = _text(entry, "relation")
        values = _values(types.relating(name).properties, entry)
        relations.append(Relation(ends[0], name, ends[1], values))
    return list(nodes.values()), relations


def _entries(document: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    entries: list[Any] | None = document.get(key)
    if not isinstance(entries, list):
        raise RuleError(f"the document's {key!r} must be a list, not {entries!r}")
    for entry in entries:
        if not isinstance(entry, Mapping):
            raise RuleError(f"an entry of the document's {key!r} is {entry!r}, which has no keys and values")
    return entries


def _text(entry: Mapping[str, Any], key: str) -> str:
    value = entry.get(key)
    if not isinstance(value, str) or not value:
        raise RuleError(f"the entry {dict(entry)} needs a text as {key!r}")
    return value


def _plain(values: Mapping[str, Value]) -> dict[str, Any]:
    return {name: value.isoformat() if isinstance(value, (date, datetime)) else value for name, value in values.items()}


def _values(kinds: Mapping[str, Kind], entry: Mapping[str, Any]) -> dict[str, Value]:
    found: dict[str, Value] = {}
    given = entry.get("properties", {})
    if not isinstance(given, Mapping):
        raise RuleError(f"the properties of {dict(entry)} must be keys and values")
    for name, value in cast("Mapping[str, Any]", given).items():
        try:
            if kinds.get(name) == "date":
                value = date.fromisoformat(value)
            elif kinds.get(name) == "time":
                value = datetime.fromisoformat(value)
        except (TypeError, ValueError):
            raise RuleError(f"{name} = {value!r} of {dict(entry)} is not a valid {kinds[name]} in ISO 8601") from None
        found[name] = value
    return found
