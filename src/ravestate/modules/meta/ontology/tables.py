"""The tables and columns that ladybug (the embedded graph database) needs for types and relations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from ravestate.errors import PlatformError

from .database import FILE_FORMAT, META, NAME, NODE, RELATION, aside, meta_table, node_table, relation_table
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
    """Return whether the database has a format older than the newest one, and so must be copied before its use.

    Args:
        execute: A function that runs a statement and returns its rows.
        place: The database's path, for messages.

    Raises:
        PlatformError: The database belongs to another program, or has a format newer than the newest known one.
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


def missing_tables(execute: Execute, types: Types, in_use: Iterable[Types], place: str) -> Iterator[str]:
    """Yield the statements that create missing tables and columns.

    Args:
        execute: A function that runs a statement and returns its rows.
        types: The types that need columns.
        in_use: The types of other contexts that have the database open.
        place: The database's path, for messages.

    Raises:
        PlatformError: A property in the database has another kind than in `types`.
    """
    tables = _tables(execute)
    if META not in tables:
        yield from meta_table()
    (of_nodes, of_relations), (used, used_relations) = _owners([types]), _owners(in_use)
    for table, owners, others, create in (
        (NODE, of_nodes, used, node_table),
        (RELATION, of_relations, used_relations, relation_table),
    ):
        owned = _owned(owners)
        if table in tables:
            yield from _missing_columns(execute, table, owned, others, place)
        else:
            yield create({name: COLUMNS[kind] for name, (kind, _) in owned.items()})


def undeclared_types(execute: Execute, types: Types) -> list[str]:
    """Return the names of the types that have nodes in the database but are not in `types`."""
    found = {str(id).partition(":")[0] for [id] in execute(f"MATCH (n:`{NODE}`) RETURN n.`id`")}
    return sorted(found - {*types})


def _tables(execute: Execute) -> set[str]:
    return {str(row[0]) for row in execute("CALL show_tables() RETURN name")}


def _owners(all_types: Iterable[Types]) -> tuple[dict[str, Mapping[str, Kind]], dict[str, Mapping[str, Kind]]]:
    """Return the properties of each type, and the properties of each relation."""
    nodes: dict[str, Mapping[str, Kind]] = {}
    relations: dict[str, Mapping[str, Kind]] = {}
    for types in all_types:
        nodes |= {name: {**nodes.get(name, {}), **types.properties(name)} for name in types}
        for name, one in types.relations.items():
            relations[name] = {**relations.get(name, {}), **one.properties}
    return nodes, relations


def _owned(owners: Mapping[str, Mapping[str, Kind]]) -> dict[str, tuple[Kind, list[str]]]:
    """Return the kind of each property, and its owners: the types or relations that have it.

    `Types` gives a property the same kind for all owners.
    """
    owned: dict[str, tuple[Kind, list[str]]] = {}
    for owner, properties in owners.items():
        for name, kind in properties.items():
            owned.setdefault(name, (kind, []))[1].append(owner)
    return owned


def _missing_columns(
    execute: Execute,
    table: str,
    owned: Mapping[str, tuple[Kind, list[str]]],
    in_use: Mapping[str, Mapping[str, Kind]],
    place: str,
) -> Iterator[str]:
    """Yield the statements for the columns of one table.

    A declared property may need the name of a column that has only values of undeclared types. That column then gets
    a new name.
    """
    columns = {str(row[0]): str(row[1]) for row in execute(f"CALL table_info('{table}') RETURN name, type")}
    by_letters = {name.lower(): name for name in columns}
    for name, (kind, owners) in owned.items():
        present = by_letters.get(name.lower(), name)
        if columns.get(name) == COLUMNS[kind]:
            continue
        if present in columns:
            used = [owner for owner in in_use if present in in_use[owner]]
            for owner in (*used, *_with_value(execute, table, present, owners)):
                held = next((k for k, column in COLUMNS.items() if column == columns[present]), columns[present])
                raise PlatformError(
                    f"memory {place} has {owner}.{present} as {held}, but the types say {kind}: write {present}: {held}, or "
                    "give the property another name. Nothing was changed"
                )
            yield f"ALTER TABLE `{table}` RENAME `{present}` TO `{aside(present, columns[present])}`"
        if (kept := aside(name, COLUMNS[kind])) in columns:
            yield f"ALTER TABLE `{table}` RENAME `{kept}` TO `{name}`"
        else:
            yield f"ALTER TABLE `{table}` ADD `{name}` {COLUMNS[kind]}"


def _with_value(execute: Execute, table: str, column: str, owners: Iterable[str]) -> Iterator[str]:
    """Yield those of the `owners` (types or relations) that have a value in a column."""
    pattern = f"(n:`{table}`)" if table == NODE else f"()-[n:`{table}`]->()"
    for owner in owners:
        test = f"n.`id` STARTS WITH '{owner}:'" if table == NODE else f"n.`{NAME}` = '{owner}'"
        if execute(f"MATCH {pattern} WHERE {test} AND n.`{column}` IS NOT NULL RETURN 1 LIMIT 1"):
            yield owner
