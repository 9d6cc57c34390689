"""Opening and copying a ladybug database.

A damaged file can crash the process that opens it, so a separate process opens the file first.
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
"""The seconds that a trial in a separate process may take."""


def connect(path: Path, *, whole_log: bool = True) -> tuple[Any, Any]:
    """Open a database, and return it with a connection to it.

    Args:
        path: The database file; created if it is missing.
        whole_log: Whether a damaged log is an error. If not, the log is read up to the damage, and the rest is cut off.

    Raises:
        Exception: RuntimeError if the file has lost all of its tables. For a damaged file, ladybug may raise any
            exception.
    """
    import ladybug

    size = path.stat().st_size if path.exists() else 0
    database = ladybug.Database(
        str(path),
        buffer_pool_size=BUFFER,
        max_db_size=LARGEST,
        max_num_threads=1,
        auto_checkpoint=False,  # the store makes checkpoints later, since a checkpoint here could make the opening fail
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
    """Return whether a separate process can read the whole file without a crash. An exception counts as no crash."""
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


def copy_database(source: Any, target: Any) -> None:
    """Copy all tables, nodes and relations in one transaction, even tables of types that memory does not declare.

    The copy has no bytes of deleted nodes; the old file still has them.

    Args:
        source: A connection to the database to copy.
        target: A connection to an empty database.

    Raises:
        RuntimeError: Ladybug failed.
    """
    tables = _rows(source, "CALL show_tables() RETURN name, type")
    copied: dict[tuple[int, int], tuple[str, str, Any]] = {}  # ladybug's own number → type, name of the key, key
    _rows(target, "BEGIN TRANSACTION")
    for name in (name for name, kind in tables if kind == "NODE"):
        columns = {row[1]: (row[2], row[4]) for row in _rows(source, f"CALL table_info('{name}') RETURN *")}
        listed = [f"`{key}` {kind}" + (" PRIMARY KEY" if primary else "") for key, (kind, primary) in columns.items()]
        _rows(target, f"CREATE NODE TABLE `{name}` ({', '.join(listed)})")
        primary_key = next(key for key, (_, primary) in columns.items() if primary)
        for [node] in _rows(source, f"MATCH (n:`{name}`) RETURN n"):
            pattern, values = _pattern(node, columns)
            _rows(target, f"CREATE (:`{name}` {pattern})", values)
            copied[_number(node["_ID"])] = name, primary_key, node[primary_key]
    for name in (name for name, kind in tables if kind == "REL"):
        columns = {row[1]: row[2] for row in _rows(source, f"CALL table_info('{name}') RETURN *")}
        pairs = _rows(source, f"CALL show_connection('{name}') RETURN *")
        listed = [f"FROM `{one}` TO `{other}`" for one, other, *_ in pairs]
        listed += [f"`{key}` {kind}" for key, kind in columns.items()]
        _rows(target, f"CREATE REL TABLE `{name}` ({', '.join(listed)})")
        # One query for all pairs of types: most of the hundreds of pairs have no relation.
        for [relation] in _rows(source, f"MATCH ()-[r:`{name}`]->() RETURN r"):
            one, one_key, a = copied[_number(relation["_SRC"])]
            other, other_key, b = copied[_number(relation["_DST"])]
            ends = f"MATCH (a:`{one}` {{`{one_key}`: $a}}), (b:`{other}` {{`{other_key}`: $b}})"
            pattern, values = _pattern(relation, columns)
            _rows(target, f"{ends} CREATE (a)-[:`{name}` {pattern}]->(b)", {"a": a, "b": b, **values})
    _rows(target, "COMMIT")


def _rows(connection: Any, statement: str, parameters: Mapping[str, Any] | None = None) -> list[list[Any]]:
    return connection.execute(statement, dict(parameters or {})).get_all()


def _number(found: Mapping[str, int]) -> tuple[int, int]:
    return found["table"], found["offset"]


def _pattern(found: Mapping[str, Any], columns: Mapping[str, object]) -> tuple[str, dict[str, Any]]:
    """Return the Cypher pattern of properties, and its parameters."""
    keys = [key for key in columns if found.get(key) is not None]
    pattern = "{" + ", ".join(f"`{key}`: $p_{key}" for key in keys) + "}" if keys else ""
    return pattern, {f"p_{key}": found[key] for key in keys}


if __name__ == "__main__":
    try:
        _read_all(Path(sys.argv[1]), whole_log=sys.argv[2] == "whole")
    finally:
        os._exit(0)  # end without writing anything
