"""The tables and columns that ladybug needs for types and relations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from ravestate.errors import PlatformError

from .database import FILE_FORMAT, META, NODE, RELATION, meta_table, node_table, relation_table
from .store import check_format
from .types import Kind, Types

Execute = Callable[[str], list[list[Any]]]

COLUMNS: dict[Kind, str] = {
    "text": "STRING",
    "integer": "INT64",
    "number": "DOUBLE",
    "yes/no": "BOOL",
    "date": "STRING",
    "time": "STRING",
}


def has_old_format(execute: Execute, place: str) -> bool:
    """Return whether the database has an older format, and so must be copied before its use.

    Args:
        execute: A function that runs a statement and returns its rows.
        place: The database's path, for messages.

    Raises:
        PlatformError: The database belongs to something else, or has a newer format.
    """
    tables = _tables(execute)
    if META in tables:
        found = execute(f"MATCH (m:`{META}` {{`key`: 'format'}}) RETURN m.`value`")
        return check_format(place, found[0][0] if found else None, FILE_FORMAT) < FILE_FORMAT
    if tables:
        raise PlatformError(
            f"{place} is a ladybug database of another program (it has {', '.join(sorted(tables)[:3])}): name another file "
            "with --set ontology.path=FILE. Nothing was changed"
        )
    return False


def missing_tables(execute: Execute, types: Types, place: str) -> Iterator[str]:
    """Yield the statements that create missing tables and columns.

    Args:
        execute: A function that runs a statement and returns its rows.
        types: The types that need columns.
        place: The database's path, for messages.

    Raises:
        PlatformError: The database has a property of another kind.
    """
    tables = _tables(execute)
    if META not in tables:
        yield from meta_table()
    of_nodes = _owned((name, types.properties(name)) for name in types)
    of_relations = _owned((name, relation.properties) for name, relation in types.relations.items())
    for table, owned, create in ((NODE, of_nodes, node_table), (RELATION, of_relations, relation_table)):
        if table in tables:
            yield from _missing_columns(execute, table, owned, place)
        else:
            yield create({name: COLUMNS[kind] for name, (kind, _) in owned.items()})


def undeclared_types(execute: Execute, types: Types) -> list[str]:
    """Return the names of the types that have nodes in the database but are not in `types`."""
    found = {str(id).partition(":")[0] for [id] in execute(f"MATCH (n:`{NODE}`) RETURN n.`id`")}
    return sorted(found - {*types})


def _tables(execute: Execute) -> set[str]:
    return {str(row[0]) for row in execute("CALL show_tables() RETURN name")}


def _owned(owners: Iterable[tuple[str, Mapping[str, Kind]]]) -> dict[str, tuple[Kind, str]]:
    """Return the kind of each property, and its last owner: the declaration gives a name only one kind."""
    return {name: (kind, owner) for owner, properties in owners for name, kind in properties.items()}


def _missing_columns(execute: Execute, table: str, owned: Mapping[str, tuple[Kind, str]], place: str) -> Iterator[str]:
    present = {row[0]: row[1] for row in execute(f"CALL table_info('{table}') RETURN name, type")}
    for name, (kind, owner) in owned.items():
        if name not in present:
            yield f"ALTER TABLE `{table}` ADD `{name}` {COLUMNS[kind]}"
        elif present[name] != COLUMNS[kind]:
            held = next((k for k, column in COLUMNS.items() if column == present[name]), present[name])
            raise PlatformError(
                f"memory {place} has {owner}.{name} as {held}, but the types say {kind}: write {name}: {held}, or give the "
                "property another name. Nothing was changed"
            )
