"""Opening a ladybug database. A damaged file can crash the process that opens it, so a separate process tries first."""

from __future__ import annotations

import os
import subprocess
import sys
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
        whole_log: Whether a damaged log is an error. If false, the log is read up to the damage, and the rest cut off.

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
        auto_checkpoint=False,  # the store makes checkpoints later: here, one could make the opening fail
        throw_on_wal_replay_failure=whole_log,
    )
    connection = ladybug.Connection(database, num_threads=1)
    connection.execute("CALL force_checkpoint_on_close=false")
    found: Any = connection.execute("CALL show_tables() RETURN name") if size > EMPTY else None
    if found is not None and not found.get_all():  # ladybug reads pages of zeros as an empty catalog
        connection.close()
        database.close()
        raise RuntimeError("it has no tables")
    return database, connection


def survives(path: Path, *, whole_log: bool = True) -> bool:
    """Return whether a separate process survives opening the file and reading all of it. An exception is no crash."""
    command = [sys.executable, "-P", __file__, str(path), "whole" if whole_log else "part"]
    try:
        return subprocess.run(command, capture_output=True, timeout=PATIENCE, check=False).returncode >= 0
    except subprocess.TimeoutExpired:
        return False
    except OSError:  # there is no interpreter to run, for example in a single-file application
        return True


def _read_all(path: Path, *, whole_log: bool) -> None:
    connection: Any
    _database, connection = connect(path, whole_log=whole_log)
    for name, kind in connection.execute("CALL show_tables() RETURN name, type").get_all():
        pattern, found = (f"(n:`{name}`)", "n") if kind == "NODE" else (f"()-[r:`{name}`]->()", "r")
        connection.execute(f"MATCH {pattern} RETURN {found}").get_all()


if __name__ == "__main__":
    try:
        _read_all(Path(sys.argv[1]), whole_log=sys.argv[2] == "whole")
    finally:
        os._exit(0)  # end without writing anything
