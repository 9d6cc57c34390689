"""The tables that ladybug needs for types and relations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ravestate.errors import PlatformError

from .store import FORMAT, check_format
from .types import Kind, Types

Execute = Callable[[str], list[list[Any]]]

META = "_ravestate"
"""The table that stores the format version. No user's type begins with ``_``."""

COLUMNS: dict[Kind, str] = {
    "text": "STRING",
    "integer": "INT64",
    "number": "DOUBLE",
    "yes/no": "BOOL",
    "date": "STRING",
    "time": "STRING",
}


def missing_tables(execute: Execute, types: Types, place: str) -> Iterator[str]:
    """Yield the statements that create missing tables and columns.

    Args:
        execute: A function that runs a statement and returns its rows.
        types: The types that need tables.
        place: The database's path, for messages.

    Raises:
        PlatformError: The database belongs to something else, has a newer format, or has a property of another kind.
    """
    tables = {str(row[0]) for row in execute("CALL show_tables() RETURN name")}
    if META in tables:
        found = execute(f"MATCH (m:`{META}` {{`key`: 'format'}}) RETURN m.`value`")
        check_format(place, found[0][0] if found else None)
    elif tables:
        raise PlatformError(
            f"{place} is a ladybug database of another program (it has {', '.join(sorted(tables)[:3])}): name another file "
            "with --set ontology.path=FILE. Nothing was changed"
        )
    else:
        yield f"CREATE NODE TABLE `{META}` (`key` STRING PRIMARY KEY, `value` INT64)"
        yield f"CREATE (:`{META}` {{`key`: 'format', `value`: {FORMAT}}})"
    for name in types:
        columns = types.properties(name)
        if name in tables:
            yield from _missing_columns(execute, name, columns, place)
        else:
            yield f"CREATE NODE TABLE `{name}` ({', '.join(['`id` STRING PRIMARY KEY', *_columns(columns)])})"
    for name, relation in types.relations.items():
        pairs = types.pairs(name)
        if name in tables:
            present = {(row[0], row[1]) for row in execute(f"CALL show_connection('{name}') RETURN *")}
            for source, target in pairs:
                if (source, target) not in present:
                    yield f"ALTER TABLE `{name}` ADD FROM `{source}` TO `{target}`"
            yield from _missing_columns(execute, name, relation.properties, place)
        else:
            ends = [f"FROM `{source}` TO `{target}`" for source, target in pairs]
            yield f"CREATE REL TABLE `{name}` ({', '.join([*ends, *_columns(relation.properties)])})"


def undeclared_types(execute: Execute, types: Types) -> list[str]:
    """Return the names of the types that have nodes in the database but are not in `types`."""
    tables = execute("CALL show_tables() RETURN name, type")
    unknown = {str(name) for name, kind in tables if kind == "NODE"} - {META, *types}
    return sorted(name for name in unknown if execute(f"MATCH (n:`{name}`) RETURN n.`id` LIMIT 1"))


def _missing_columns(execute: Execute, table: str, properties: Mapping[str, Kind], place: str) -> Iterator[str]:
    present = {row[0]: row[1] for row in execute(f"CALL table_info('{table}') RETURN name, type")}
    for name, kind in properties.items():
        if name not in present:
            yield f"ALTER TABLE `{table}` ADD `{name}` {COLUMNS[kind]}"
        elif present[name] != COLUMNS[kind]:
            held = next((k for k, column in COLUMNS.items() if column == present[name]), present[name])
            raise PlatformError(
                f"memory {place} has {table}.{name} as {held}, but the types say {kind}: write {name}: {held}, or give the "
                "property another name. Nothing was changed"
            )


def _columns(properties: Mapping[str, Kind]) -> list[str]:
    return [f"`{name}` {COLUMNS[kind]}" for name, kind in properties.items()]
