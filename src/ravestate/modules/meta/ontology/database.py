"""Functions that open and copy a database of ladybug, an embedded graph database.

A damaged file can crash the process that opens it. So `survives` lets a separate process open the file first.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

BUFFER = 256 * 2**20
"""The maximum number of bytes of main memory for pages of the database file."""

EMPTY = 4 * 4096
"""The maximum number of bytes in the file of a database that never had a table."""

LARGEST = 2**36
"""The bytes of address space that are reserved for the database file, and so the file's maximum size."""

PATIENCE = 60.0
"""The seconds that a separate process may take to read the file; see `survives`."""

FILE_FORMAT = 2
"""The version of the format of nodes and relations in the file; a new format has a greater number.

Format 1 had a table for each type and a table for each relation. Ladybug takes 3.5 MB of main memory for a table of
nodes, and 10 MB for a table of relations after a write to it. Format 2 has one table for all nodes, and one for all
relations.
"""

META = "_ravestate"
"""The table with the format's version, and with a mark if deleted nodes have left bytes behind."""

NODE = "_node"
"""The table of all nodes. The id of a node begins with its type: ``City:...``."""

RELATION = "_relation"
"""The table of all relations. The names of the tables begin with ``_``, so they differ from all names of users."""

NAME = "_name"
"""The column with the name of a relation."""


def connect(path: Path, *, whole_log: bool = True) -> tuple[Any, Any]:
    """Open a database. Return the database, and a connection to it.

    Args:
        path: The database file; created if it is missing.
        whole_log: Whether a damaged write-ahead log is an error. If not, the log is read up to the damage, and the rest
            is cut off.

    Raises:
        Exception: The file has lost all of its tables (RuntimeError). For a damaged file, ladybug may raise any
            exception.
    """
    import ladybug

    size = path.stat().st_size if path.exists() else 0
    database = ladybug.Database(
        str(path),
        buffer_pool_size=BUFFER,
        max_db_size=LARGEST,
        max_num_threads=1,
        # A checkpoint moves the log into the file. The store does this later, because a failed checkpoint would make the
        # opening fail.
        auto_checkpoint=False,
        throw_on_wal_replay_failure=whole_log,
    )
    connection = ladybug.Connection(database, num_threads=1)
    connection.execute("CALL force_checkpoint_on_close=false")
    # Ladybug reads pages of zeros as an empty catalog, so a damaged file may seem to have no tables.
    if size > EMPTY and not _rows(connection, "CALL show_tables() RETURN name"):
        connection.close()
        database.close()
        raise RuntimeError("it has no tables")
    return database, connection


def survives(path: Path, *, whole_log: bool = True) -> bool:
    """Return whether a separate process can read the whole file without a crash. An exception is not a crash."""
    command = [sys.executable, "-P", __file__, str(path), "whole" if whole_log else "part"]
    try:
        return subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False).returncode >= 0
    except subprocess.TimeoutExpired:
        return False
    except OSError:  # there is no interpreter to run, for example in a single-file application
        return True


def _read_all(path: Path, *, whole_log: bool) -> None:
    _database, connection = connect(path, whole_log=whole_log)
    for name, kind in _rows(connection, "CALL show_tables() RETURN name, type"):
        pattern, found = (f"(n:`{name}`)", "n") if kind == "NODE" else (f"()-[r:`{name}`]->()", "r")
        _rows(connection, f"MATCH {pattern} RETURN {found}")


def node_table(columns: Mapping[str, str]) -> str:
    """Return the statement that creates the table of all nodes. `columns` maps each property to its column's kind."""
    return f"CREATE NODE TABLE `{NODE}` ({', '.join(['`id` STRING PRIMARY KEY', *_listed(columns)])})"


def relation_table(columns: Mapping[str, str]) -> str:
    """Return the statement that creates the table of all relations. `columns` maps each property to its column's kind."""
    listed = [f"FROM `{NODE}` TO `{NODE}`", f"`{NAME}` STRING", *_listed(columns)]
    return f"CREATE REL TABLE `{RELATION}` ({', '.join(listed)})"


def aside(name: str, kind: str) -> str:
    """Return the name of a second column for a property, if values of another kind occupy the column `name`.

    Ladybug ignores the case of a column's name, so this name has the property's name in hexadecimal digits.
    """
    return f"_{kind}_{name.encode().hex()}"


def meta_table() -> list[str]:
    """Return the statements that create the table with the format's version."""
    return [
        f"CREATE NODE TABLE `{META}` (`key` STRING PRIMARY KEY, `value` INT64)",
        f"CREATE (:`{META}` {{`key`: 'format', `value`: {FILE_FORMAT}}})",
    ]


def copy_database(source: Any, target: Any) -> None:
    """Copy all nodes and relations in one transaction, even those of types that memory does not declare.

    The copy has the newest format, and no bytes of deleted nodes; the old file still has them.

    Args:
        source: A connection to the database to copy, of any known format.
        target: A connection to an empty database.

    Raises:
        RuntimeError: Ladybug failed.
    """
    tables = _rows(source, "CALL show_tables() RETURN name, type")
    nodes = {name: _columns(source, name) for name, kind in tables if kind == "NODE" and name != META}
    relations = {name: _columns(source, name) for name, kind in tables if kind == "REL"}
    _rows(target, "BEGIN TRANSACTION")
    of_nodes, of_relations = _united(nodes), _united(relations)
    for statement in (*meta_table(), node_table(_kinds(of_nodes)), relation_table(_kinds(of_relations))):
        _rows(target, statement)
    copied: dict[tuple[int, int], str] = {}  # ladybug's own number of a node → the node's id
    for name, columns in nodes.items():
        for [node] in _rows(source, f"MATCH (n:`{name}`) RETURN n"):
            values = {"id": node["id"], **_moved(node, columns, of_nodes)}
            _rows(target, f"CREATE (:`{NODE}` {_pattern(values)})", _parameters(values))
            copied[_number(node["_ID"])] = node["id"]
    for name, columns in relations.items():
        for [relation] in _rows(source, f"MATCH ()-[r:`{name}`]->() RETURN r"):
            values = {NAME: relation.get(NAME, name), **_moved(relation, columns, of_relations)}
            ends = f"MATCH (a:`{NODE}` {{`id`: $a}}), (b:`{NODE}` {{`id`: $b}})"
            pair = {"a": copied[_number(relation["_SRC"])], "b": copied[_number(relation["_DST"])]}
            _rows(target, f"{ends} CREATE (a)-[:`{RELATION}` {_pattern(values)}]->(b)", pair | _parameters(values))
    _rows(target, "COMMIT")


def _columns(connection: Any, table: str) -> dict[str, str]:
    """Return the names and kinds of a table's columns."""
    return {str(row[1]): str(row[2]) for row in _rows(connection, f"CALL table_info('{table}') RETURN *")}


def _united(tables: Mapping[str, Mapping[str, str]]) -> dict[tuple[str, str], str]:
    """Return a column for each property of all tables: name and kind of the property → name of the column.

    In format 1, two types that were never declared together may have properties of the same name but different kinds.
    """
    united: dict[tuple[str, str], str] = {}
    taken: set[str] = set()
    for columns in tables.values():
        for name, kind in columns.items():
            if name not in ("id", NAME) and (name, kind) not in united:
                united[name, kind] = aside(name, kind) if name.lower() in taken else name
                taken.add(name.lower())
    return united


def _kinds(united: Mapping[tuple[str, str], str]) -> dict[str, str]:
    return {column: kind for (_, kind), column in united.items()}


def _moved(
    found: Mapping[str, Any], columns: Mapping[str, str], united: Mapping[tuple[str, str], str]
) -> dict[str, Any]:
    """Return the values of a node or relation: column in the copy → value. Leave out properties without a value."""
    given = {united[one]: found.get(one[0]) for one in columns.items() if one in united}
    return {column: value for column, value in given.items() if value is not None}


def _listed(columns: Mapping[str, str]) -> list[str]:
    return [f"`{name}` {kind}" for name, kind in columns.items()]


def _rows(connection: Any, statement: str, parameters: Mapping[str, Any] | None = None) -> list[list[Any]]:
    return connection.execute(statement, dict(parameters or {})).get_all()


def _number(found: Mapping[str, int]) -> tuple[int, int]:
    return found["table"], found["offset"]


def _pattern(values: Mapping[str, Any]) -> str:
    """Return the part of a Cypher pattern that lists properties."""
    return "{" + ", ".join(f"`{key}`: $p_{key}" for key in values) + "}" if values else ""


def _parameters(values: Mapping[str, Any]) -> dict[str, Any]:
    return {f"p_{key}": value for key, value in values.items()}


if __name__ == "__main__":
    try:
        _read_all(Path(sys.argv[1]), whole_log=sys.argv[2] == "whole")
    finally:
        os._exit(0)  # end without writing anything
