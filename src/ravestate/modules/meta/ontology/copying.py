"""Copying a ladybug database: deleted nodes, whose bytes stay in the old file, are not in the copy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

Rows = list[list[Any]]


def copy_database(source: Any, target: Any) -> None:
    """Copy all tables, nodes and relations in one transaction, including those that no type declares.

    Args:
        source: A connection to the database to copy.
        target: A connection to an empty database.

    Raises:
        RuntimeError: Ladybug failed.
    """
    tables = _rows(source, "CALL show_tables() RETURN name, type")
    _rows(target, "BEGIN TRANSACTION")
    nodes = [str(name) for name, kind in tables if kind == "NODE"]
    for name in nodes:
        columns = {row[1]: (row[2], row[4]) for row in _rows(source, f"CALL table_info('{name}') RETURN *")}
        listed = [f"`{key}` {kind}" + (" PRIMARY KEY" if primary else "") for key, (kind, primary) in columns.items()]
        _rows(target, f"CREATE NODE TABLE `{name}` ({', '.join(listed)})")
        for [node] in _rows(source, f"MATCH (n:`{name}`) RETURN n"):
            values = _values(node, columns)
            _rows(target, f"CREATE (:`{name}` {_pattern(values)})", _parameters(values))
    for name in (str(name) for name, kind in tables if kind == "REL"):
        columns = {row[1]: row[2] for row in _rows(source, f"CALL table_info('{name}') RETURN *")}
        pairs = _rows(source, f"CALL show_connection('{name}') RETURN *")
        listed = [f"FROM `{one}` TO `{other}`" for one, other, *_ in pairs]
        listed += [f"`{key}` {kind}" for key, kind in columns.items()]
        _rows(target, f"CREATE REL TABLE `{name}` ({', '.join(listed)})")
        for one, other, one_key, other_key in pairs:
            found = _rows(
                source,
                f"MATCH (a:`{one}`)-[r:`{name}`]->(b:`{other}`) RETURN a.`{one_key}`, b.`{other_key}`, r",
            )
            for a, b, relation in found:
                values = _values(relation, columns)
                _rows(
                    target,
                    f"MATCH (a:`{one}` {{`{one_key}`: $a}}), (b:`{other}` {{`{other_key}`: $b}}) "
                    f"CREATE (a)-[:`{name}` {_pattern(values)}]->(b)",
                    {"a": a, "b": b, **_parameters(values)},
                )
    _rows(target, "COMMIT")


def _rows(connection: Any, statement: str, parameters: Mapping[str, Any] | None = None) -> Rows:
    return cast("Rows", connection.execute(statement, dict(parameters or {})).get_all())


def _values(found: Mapping[str, Any], columns: Mapping[str, object]) -> dict[str, Any]:
    return {key: found[key] for key in columns if found.get(key) is not None}


def _pattern(values: Mapping[str, Any]) -> str:
    return "{" + ", ".join(f"`{key}`: $p_{key}" for key in values) + "}" if values else ""


def _parameters(values: Mapping[str, Any]) -> dict[str, Any]:
    return {f"p_{key}": value for key, value in values.items()}
