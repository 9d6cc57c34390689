"""Write and read documents, which hold the content of memory as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import date, datetime
from typing import Annotated, Any

from pydantic import BaseModel, Field, ValidationError

from ravestate.errors import RuleError

from .node import Node, Relation, Value
from .store import FORMAT
from .types import Kind, Types

_Text = Annotated[str, Field(min_length=1)]


class _Node(BaseModel):
    id: _Text
    type: _Text
    properties: dict[str, Any] = {}


class _Relation(BaseModel):
    source: _Text = Field(alias="from")
    relation: _Text
    target: _Text = Field(alias="to")
    properties: dict[str, Any] = {}


class _Document(BaseModel):
    format: Annotated[int, Field(ge=FORMAT, le=FORMAT)]
    nodes: list[_Node]
    relations: list[_Relation]


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
    try:
        read = _Document.model_validate(document)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "document"
        raise RuleError(
            f"this is not an exported memory of format {FORMAT} ({where}: {first['msg']}): write one with ravestate memory export"
        ) from None
    nodes = {one.id: Node(one.type, _values(one.id, types.properties(one.type), one), one.id) for one in read.nodes}
    relations: list[Relation] = []
    for one in read.relations:
        name = f"{one.source} {one.relation} {one.target}"
        if one.source not in nodes or one.target not in nodes:
            raise RuleError(f"the relation {name} joins nodes that the document does not have")
        values = _values(name, types.relating(one.relation).properties, one)
        relations.append(Relation(nodes[one.source], one.relation, nodes[one.target], values))
    return list(nodes.values()), relations


def _plain(values: Mapping[str, Value]) -> dict[str, Any]:
    return {name: value.isoformat() if isinstance(value, (date, datetime)) else value for name, value in values.items()}


def _values(owner: str, kinds: Mapping[str, Kind], entry: _Node | _Relation) -> dict[str, Value]:
    found = dict(entry.properties)
    for name, value in found.items():
        try:
            if kinds.get(name) in ("date", "time"):
                found[name] = (date if kinds[name] == "date" else datetime).fromisoformat(value)
        except (TypeError, ValueError):
            raise RuleError(f"{name} = {value!r} of {owner} is not a valid {kinds[name]} in ISO 8601") from None
    return found
