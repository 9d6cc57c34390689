"""The embedded graph database: ladybug, one file."""

from __future__ import annotations

import contextlib
import ctypes
import logging
import os
import shutil
from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from ravestate.errors import PlatformError
from ravestate.modules._loading import LOADING

from .copying import copy_database
from .faults import is_failed_write, is_torn_log, reason, why_not_opened
from .store import RawNode, RawRelation
from .tables import missing_tables, undeclared_types
from .types import Types

__all__ = ["EmbeddedStore"]

BUFFER = 256 * 2**20
"""Bytes of memory that pages of the file may take at most."""

LARGEST = 2**36
"""Bytes of address space for the file: it cannot grow beyond."""

RESERVE = 16 * 2**20
"""Free bytes on the disk below which nothing is written any more: the database stands no write that fails."""

LOG_LIMIT = 4 * 2**20
"""Bytes of the write-ahead log from which it is worked into the file."""

log = logging.getLogger("ravestate.ontology")


class EmbeddedStore:
    """A file that ladybug keeps, in this process alone.

    What is committed is in the write-ahead log, on disk. When a write to that log fails, the database would hang in
    the next one, and end the process when it is closed. So there is a look at the free space before each write;
    should one fail all the same, its torn record is cut off, nothing more is written, and the database is neither
    closed nor collected until its files can be written again.
    """

    def __init__(self, path: Path) -> None:
        """Open a file, or make a new one.

        Args:
            path: The file; its folder is made where it is missing, for the user alone.

        Raises:
            PlatformError: The package is missing, or the file is in use, broken, newer, or cannot be written.
        """
        try:
            with LOADING:
                import ladybug
        except ImportError as error:
            raise PlatformError("ontology needs ladybug: pip install 'ravestate[ontology]'") from error
        self._ladybug = ladybug
        self._path = path
        self._log = path.with_name(path.name + ".wal")
        self._log_limit = LOG_LIMIT
        self._log_good = 0
        self._stuck = ""
        self._within = False
        self._purge_due = False
        self._prepared: Types | None = None
        try:
            path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError as error:
            raise PlatformError(f"memory {path}: cannot make its folder: {error.strerror}") from error
        if not path.exists():
            self._check_space(0)
        self._open()

    # ------------------------------------------------------------------------------------ statements

    def read(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes nothing."""
        return [[_decoded(value) for value in row] for row in self._execute(statement, parameters)]

    def write(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes."""
        self._be_writable(sum(len(value) for value in parameters.values() if isinstance(value, str)))
        rows = self.read(statement, parameters)
        if not self._within:
            self._acknowledge()
        return rows

    @contextmanager
    def transaction(self) -> Generator[None]:
        """All statements within are done together, or none."""
        if self._within:
            yield
            return
        if self._stuck:  # else each write looks for itself whether there is room; reading wants none
            self._be_writable(0)
        self._execute("BEGIN TRANSACTION")
        self._within, self._purge_due = True, False
        try:
            yield
            self._execute("COMMIT")
        except BaseException:
            with contextlib.suppress(PlatformError):  # one that failed is rolled back already
                self._execute("ROLLBACK")
            raise
        finally:
            self._within = False
        self._acknowledge()
        if self._purge_due:
            self.purge()

    def _acknowledge(self) -> None:
        """What has been written up to here is on disk."""
        self._shorten_log()
        self._log_good = self._log_size()

    def _execute(self, statement: str, parameters: Mapping[str, Any] | None = None) -> list[list[Any]]:
        try:
            result: Any = self._connection.execute(statement, dict(parameters or {}))
            return result.get_all()
        except RuntimeError as error:
            said = str(error)
            if is_failed_write(said):
                self._get_stuck(said)
                raise PlatformError(
                    f"memory {self._path} cannot be written: {reason(said)}. Make room on the disk; what was acknowledged is "
                    "safe, and memory goes on when there is"
                ) from error
            if "Cannot open file" in said:  # its log's, in a folder that is read-only, say
                raise PlatformError(why_not_opened(self._path, said)) from error
            raise PlatformError(f"memory {self._path} failed: {said.strip()}") from error

    # ------------------------------------------------------------------------------------ tables

    def prepare(self, types: Types) -> None:
        """Make room for all types, properties and relations that are not there yet."""
        if types is self._prepared:  # as those before have asked for; nobody else writes this file
            return
        missing = list(missing_tables(self._execute, types, str(self._path)))
        if missing:  # else nothing is written: a memory may be read from a full disk
            self._be_writable(0)
            with self.transaction():
                for statement in missing:
                    self._execute(statement)
        self._prepared = types

    def undeclared(self, types: Types) -> list[str]:
        """The types of nodes in the file that `types` do not have."""
        return undeclared_types(self._execute, types)

    # ------------------------------------------------------------------------------------ the file

    def _open(self) -> None:
        self._prepared = None
        try:
            self._connect()
        except RuntimeError as error:
            if not is_torn_log(str(error)):
                raise PlatformError(why_not_opened(self._path, str(error))) from error
            self._save_what_can_be_read()
        self._log_good = self._log_size()
        with contextlib.suppress(OSError):  # of another user's, who lets us write it
            self._path.chmod(0o600)

    def _connect(self, *, whole_log: bool = True) -> None:
        self._database, self._connection = self._connected(self._path, whole_log=whole_log)

    def _connected(self, path: Path, *, whole_log: bool = True) -> tuple[Any, Any]:
        database = self._ladybug.Database(
            str(path),
            buffer_pool_size=BUFFER,
            max_db_size=LARGEST,
            max_num_threads=1,
            auto_checkpoint=False,  # done here, where it may fail
            throw_on_wal_replay_failure=whole_log,
        )
        connection = self._ladybug.Connection(database, num_threads=1)
        connection.execute("CALL force_checkpoint_on_close=false")
        return database, connection

    def _save_what_can_be_read(self) -> None:
        """Open with a log that is damaged, mostly at its end, where a power failure has torn a record."""
        number = 1
        while (copy := self._log.with_name(f"{self._log.name}.damaged-{number}")).exists():
            number += 1
        try:
            shutil.copyfile(self._log, copy)
            self._connect(whole_log=False)
        except OSError as error:
            raise PlatformError(
                f"memory {self._path} has a damaged log, which cannot be copied before it is mended: {error.strerror}"
            ) from error
        except RuntimeError as error:
            raise PlatformError(why_not_opened(self._path, str(error))) from error
        log.warning(
            "memory %s has a damaged log: what stands before the damage was read, and the log as it was is kept as %s",
            self._path,
            copy,
        )

    def purge(self) -> None:
        """Write the file anew without what was deleted, of which it still has the bytes.

        Should that fail, what was deleted is no longer known all the same; a warning says so.
        """
        if self._within:
            self._purge_due = True  # when it is done
            return
        new = self._path.with_name(self._path.name + ".new")
        try:
            self._check_space(2 * (self._path.stat().st_size + self._log_size()))
            self._execute("CHECKPOINT")
            for left_over in (
                new,
                new.with_name(new.name + ".wal"),
            ):  # of a process that was killed right here
                left_over.unlink(missing_ok=True)
            database, connection = self._connected(new)
            try:
                copy_database(self._connection, connection)
                connection.execute("CHECKPOINT")
            finally:
                connection.close()
                database.close()
            with new.open("rb") as file:
                os.fsync(file.fileno())
            self._connection.close()
            self._database.close()
            try:
                new.replace(self._path)
            finally:
                self._open()
        except (PlatformError, RuntimeError, OSError) as error:
            log.warning(
                "memory %s: what was forgotten is gone, but the file still has its bytes: %s",
                self._path,
                error,
            )
            with contextlib.suppress(OSError):
                new.unlink(missing_ok=True)

    def tidy(self) -> None:
        """Work the log into the file: until then the database holds some megabytes for each table written to."""
        self._shorten_log(limit=0)

    def close(self) -> None:
        """Let go of the file, its log worked in. If it cannot be written, the log is for the next opening."""
        if self._stuck and not self._can_write():
            log.warning("memory %s stays open until the process ends: %s", self._path, self._stuck)
            return
        self._shorten_log(limit=0)
        self._connection.close()
        self._database.close()

    def _shorten_log(self, limit: int | None = None) -> None:
        size = self._log_size()
        if size <= (self._log_limit if limit is None else limit) or self._stuck:
            return
        try:
            self._check_space(4 * size)
            self._execute("CHECKPOINT")
            self._log_limit = LOG_LIMIT
        except PlatformError as error:  # nothing is lost, and it may go better next time
            self._log_limit = 2 * size
            log.warning("memory %s keeps a log of %d bytes: %s", self._path, size, error)

    def _log_size(self) -> int:
        try:
            return self._log.stat().st_size
        except OSError:
            return 0

    def _check_space(self, needed: int) -> None:
        try:
            free = shutil.disk_usage(self._path.parent).free
        except OSError:
            return  # the write itself will tell
        if free < RESERVE + needed:
            raise PlatformError(
                f"memory {self._path} cannot be written: the disk is full ({free // 2**20} MB free, and it wants "
                f"{(RESERVE + needed) // 2**20 + 1}). Make room; what was acknowledged is safe, and memory goes on when there is"
            )

    def _be_writable(self, size: int) -> None:
        self._check_space(4 * size)
        if not self._stuck:
            return
        if not self._can_write():
            raise PlatformError(
                f"memory {self._path} cannot be written: {self._stuck}. Make room on the disk; what was acknowledged is safe, "
                "and memory goes on when there is"
            )
        self._connection.close()
        self._database.close()
        self._stuck = ""
        self._open()

    def _get_stuck(self, said: str) -> None:
        self._stuck = reason(said)
        with contextlib.suppress(OSError):
            os.truncate(self._log, self._log_good)  # a record that is torn would stop the next opening
        for held in (self._connection, self._database):  # never collected: that would end the process
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(held))

    def _can_write(self) -> bool:
        """Whether a file beside the log can be made a little longer than the log is."""
        probe = self._path.with_name(self._path.name + ".probe")
        try:
            with probe.open("wb") as file:
                file.truncate(self._log_size())
                file.seek(0, os.SEEK_END)
                file.write(bytes(2**20))
                file.flush()
                os.fsync(file.fileno())
            return True
        except OSError:
            return False
        finally:
            probe.unlink(missing_ok=True)


def _decoded(value: Any) -> Any:
    if isinstance(value, dict) and "_LABEL" in value:
        found = cast("dict[str, Any]", value)
        return (RawRelation if "_SRC" in found else RawNode)(found["_LABEL"], found)
    return cast("Any", value)
