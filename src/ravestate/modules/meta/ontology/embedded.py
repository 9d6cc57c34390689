"""A store in a single file: the embedded graph database ladybug."""

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
from ravestate.language.heap import note_load
from ravestate.language.loading import LOADING

from .database import META, NAME, NODE, RELATION, connect, copy_database, survives
from .faults import (
    ENDS_PROCESS,
    is_about_log,
    is_damage,
    is_failed_write,
    is_foreign_log,
    reason,
    said_by,
    why_broken,
    why_not_opened,
    why_not_written,
)
from .files import AT_CHECKPOINT, MemoryFiles
from .store import Raw
from .tables import has_old_format, missing_tables, undeclared_types
from .types import Types

RESERVE = 16 * 2**20
"""This many bytes of the disk must stay free after a write, because ladybug cannot recover from a failed write."""

LOG_LIMIT = 4 * 2**20
"""When the write-ahead log is longer than this many bytes, the store moves the log's content into the database file."""

MARK = "purge"
"""The key of a mark, which is in the file if deleted nodes have left bytes there."""

log = logging.getLogger("ravestate.ontology")


class EmbeddedStore:
    """A database file of ladybug, which only this process has open.

    Committed writes are in the write-ahead log, on disk. If a write to that log fails, ladybug hangs in the next write,
    and ends the process when it closes the file. So the store checks the free space before each write. If a write still
    fails, the store cuts its incomplete record off the log. The store then writes and closes nothing until
    the disk has room again.

    Deleted nodes leave bytes in the file. A purge removes these bytes: it rewrites the file.
    """

    def __init__(self, path: Path) -> None:
        """Open a database file, or make a new one.

        Args:
            path: The file. A missing folder is created; only the user can read it.

        Raises:
            PlatformError: The package is missing; or the file is in use, damaged, of a newer version, or not writable.
        """
        try:
            with LOADING:
                import ladybug  # noqa: F401  # pyright: ignore[reportUnusedImport]  # load it while the lock is held
        except ImportError as error:
            raise PlatformError("ontology needs ladybug: pip install 'ravestate[ontology]'") from error
        self._path = path
        self._files = MemoryFiles(path)
        self._log_limit = LOG_LIMIT  # the size of the log (bytes) above which the store shortens it
        self._log_good = 0  # the size of the log (bytes) after the last acknowledged write
        self._stuck = ""  # the reason why the last write failed; empty while writes succeed
        self._within = False  # whether a transaction is open
        self._has_bytes = False  # whether the file still has bytes of deleted nodes
        self._has_failed = False  # whether a purge has failed after the last deletion or opening
        self._purge_next = False  # whether a purge follows the open transaction
        self._prepared: Types | None = None  # the types whose tables exist
        self._in_use: list[Types] = []  # the types of all contexts since the opening
        try:
            path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError as error:
            raise PlatformError(f"memory {path}: cannot make its folder: {error.strerror}") from error
        if self._files.has_database():
            self._open(trial=not self._files.is_sealed())
        else:
            self._check_space(0)
            self._set_orphans_aside(self._files.logs())
            self._open()
        self._files.remove_rewrite()  # a process that was killed during a purge leaves an unfinished rewrite

    # ------------------------------------------------------------------------------------ statements

    def labels(self, types: Sequence[str]) -> str:
        """Return the table of all nodes."""
        return f"`{NODE}`"

    def relation(self, name: str) -> str:
        """Return the table of all relations, with the relation's name."""
        return f"`{RELATION}` {{`{NAME}`: '{name}'}}"

    def read(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes nothing, and return its rows."""
        return [[_decoded(value) for value in row] for row in self._execute(statement, parameters)]

    def write(self, statement: str, parameters: Mapping[str, Any]) -> list[Sequence[Any]]:
        """Run a statement that writes, and return its rows."""
        self._be_writable(sum(len(value) for value in parameters.values() if isinstance(value, str)))
        rows = self.read(statement, parameters)
        if not self._within:
            self._acknowledge()
        return rows

    @contextmanager
    def transaction(self) -> Generator[None]:
        """Run the ``with`` block as one transaction: commit all of its statements, or none."""
        if self._within:
            yield
            return
        if self._stuck:  # a store that is not stuck checks the space at each write
            self._be_writable(0)
        self._execute("BEGIN TRANSACTION")
        self._within, self._purge_next, had_bytes = True, False, self._has_bytes
        try:
            yield
            self._execute("COMMIT")
        except BaseException:
            self._has_bytes = had_bytes
            with contextlib.suppress(PlatformError):  # a failed transaction may be rolled back already
                self._execute("ROLLBACK")
            raise
        finally:
            self._within = False
        self._acknowledge()
        if self._purge_next:
            self.purge()

    def _acknowledge(self) -> None:
        """Note that all writes so far are on disk. If the log is long, shorten it."""
        self._shorten_log()
        self._log_good = self._files.log_size()

    def _execute(self, statement: str, parameters: Mapping[str, Any] | None = None) -> list[list[Any]]:
        try:
            result: Any = self._connection.execute(statement, dict(parameters or {}))
            return result.get_all()
        except Exception as error:  # reading a damaged page may raise any exception
            said = said_by(error)
            if is_failed_write(said):
                self._get_stuck(said)
                raise PlatformError(why_not_written(self._path, self._stuck)) from error
            if "Cannot open file" in said:  # for example the log, in a read-only folder
                raise PlatformError(why_not_opened(self._path, said, self._files.present())) from error
            if is_damage(error):
                raise PlatformError(why_broken(self._path, said, self._files.present())) from error
            raise PlatformError(f"memory {self._path} failed: {said}") from error

    # ------------------------------------------------------------------------------------ tables

    def prepare(self, types: Types) -> None:
        """Create the tables and columns that the types need and the file lacks. Bring a file of an older format up to date."""
        if types is self._prepared:  # no other process changes the file, so the tables are still there
            return
        if has_old_format(self._execute, str(self._path)):
            try:
                self._rewrite()
            except Exception as error:  # copying a damaged page may raise any exception
                why = f"cannot be copied to the new format: {said_by(error)}. Nothing was changed"
                raise PlatformError(f"memory {self._path} {why}") from error
        missing = list(missing_tables(self._execute, types, self._in_use, str(self._path)))
        if missing:  # write only if needed, so that memory on a full disk can be read
            self._be_writable(0)
            with self.transaction():
                for statement in missing:
                    self._execute(statement)
        self._has_bytes = bool(self._execute(f"MATCH (m:`{META}` {{`key`: '{MARK}'}}) RETURN m.`value`"))
        self._has_failed = False
        self._prepared = types
        self._in_use = [*(one for one in self._in_use if one is not types), types]

    def undeclared(self, types: Types) -> list[str]:
        """Return the types that have nodes in the file and are not in `types`."""
        return undeclared_types(self._execute, types)

    # ------------------------------------------------------------------------------------ the file

    def _open(self, *, trial: bool = False) -> None:
        self._prepared = None
        self._files.make_private("")
        problem = self._attempt(trial=trial)
        if problem and is_foreign_log(problem):
            self._set_orphans_aside(self._files.logs())
            problem = self._attempt(trial=trial)
        if problem and is_about_log(problem) and self._files.log_size():
            problem = self._open_in_part() and problem
        if problem:
            raise PlatformError(why_not_opened(self._path, problem, self._files.present()))
        self._log_good = self._files.log_size()
        self._files.restrict()

    def _attempt(self, *, trial: bool, whole_log: bool = True) -> str:
        """Open the file; return the error, or "" if there is none. With `trial`, a separate process opens it first."""
        if trial and not survives(self._path, whole_log=whole_log):
            return ENDS_PROCESS
        try:
            self._database, self._connection = connect(self._path, whole_log=whole_log)
        except Exception as error:  # opening a damaged file may raise any exception
            return said_by(error)
        return ""

    def _open_in_part(self) -> str:
        """Open a file with a log that a power failure has cut off. Return the error, or "" if there is none.

        The log is read up to the damage, or not at all if that is not possible. A copy of the log is kept.
        """
        log_file = self._files.log
        try:
            [copy] = self._files.set_aside([log_file], "damaged")
            shutil.copyfile(copy, log_file)
            problem = self._attempt(trial=True, whole_log=False)
            if problem:
                log_file.unlink()
                problem = self._attempt(trial=True)
            if problem:
                copy.replace(log_file)
                return problem
        except OSError as error:
            raise PlatformError(
                f"memory {self._path} has a damaged log, which cannot be copied before its repair: {error.strerror}"
            ) from error
        if self._files.log_size():  # the opening has cut the log off at the damage
            read = "memory has read the part before the damage"
        else:
            read = "nothing in it can be read, so the newest writes are missing"
        log.warning("memory %s has a damaged log: %s; a copy of the damaged log is %s", self._path, read, copy)
        return ""

    def _set_orphans_aside(self, orphans: list[Path]) -> None:
        """Rename logs of an earlier database that was deleted without its logs."""
        if not orphans:
            return
        try:
            kept = self._files.set_aside(orphans, "orphaned")
        except OSError as error:
            raise PlatformError(
                f"memory {self._path}: {', '.join(map(str, orphans))} belong to a memory that was deleted, and cannot be "
                f"renamed ({error.strerror}): remove them"
            ) from error
        log.warning(
            "memory %s ignores the logs of an earlier memory that was deleted; they may contain personal data. "
            "They are kept as %s. To remove them: rm, or ravestate memory reset --path %s",
            self._path,
            ", ".join(map(str, kept)),
            self._path,
        )

    def note_bytes(self) -> None:
        """Note in the file that the file still has the bytes of deleted nodes."""
        self._has_failed = False
        if not self._has_bytes:
            self.write(f"MERGE (m:`{META}` {{`key`: '{MARK}'}}) SET m.`value` = 1", {})
            self._has_bytes = True

    def purge(self) -> None:
        """If nodes were deleted, rewrite the file without them. In a transaction, do this after the commit.

        If this fails, the deleted nodes are still forgotten. A warning says that the file still has their bytes. The
        next purge, deletion, closing or opening leads to another try.
        """
        if not self._has_bytes:
            return
        if self._within:
            self._purge_next = True
            return
        try:
            self._rewrite()
            self._has_bytes = False
        except Exception as error:  # copying a damaged page may raise any exception
            self._has_failed = True
            log.warning(
                "memory %s: the forgotten nodes are gone, but the file still has their bytes: %s", self._path, error
            )
        if kept := ", ".join(map(str, self._files.kept())):
            what = "logs that were set aside may still have data of the forgotten nodes; remove them"
            log.warning("memory %s: %s: %s", self._path, what, kept)

    def rest(self) -> None:
        """Purge the file, unless a purge has failed since the last deletion.

        The worker thread calls this method in each pause between jobs. After a failure, each pause would log the same
        warning again.
        """
        if not self._has_failed:
            self.purge()

    def _rewrite(self) -> None:
        """Copy the database to a new file, without deleted nodes and with the newest format; replace the old file."""
        new = MemoryFiles(self._files.beside(".new"))
        try:
            self._be_writable(0)  # this opens the file again if a write has failed
            self._check_space(2 * (self._path.stat().st_size + self._files.log_size()))
            self._checkpoint()
            self._files.remove_rewrite()
            new.make_private("")
            database, connection = connect(new.path)
            try:
                new.make_private(".wal")
                copy_database(self._connection, connection)
                new.make_private(*AT_CHECKPOINT)
                connection.execute("CHECKPOINT")
            finally:
                connection.close()
                database.close()
            with new.path.open("rb") as file:
                os.fsync(file.fileno())
            self._connection.close()
            self._database.close()
            try:
                new.path.replace(self._path)
                self._files.seal()
            finally:
                self._open()
        except BaseException:
            with contextlib.suppress(OSError):
                self._files.remove_rewrite()
            raise
        finally:
            note_load()  # two open databases have needed tens of megabytes more than one

    def tidy(self) -> None:
        """Move the log's content into the file. Until then, each written table costs megabytes of main memory."""
        self._shorten_log(limit=0)

    def close(self) -> None:
        """Purge the file, move the log's content into it, and close it. If the move fails, the next opening does it."""
        if self._stuck and not self._files.can_write():
            log.warning("memory %s stays open until the process ends: %s", self._path, self._stuck)
            return
        self.purge()
        self._shorten_log(limit=0)
        self._connection.close()
        self._database.close()
        self._files.remove_empty()
        self._files.seal()

    def _shorten_log(self, limit: int | None = None) -> None:
        size = self._files.log_size()
        if size <= (self._log_limit if limit is None else limit) or self._stuck:
            return
        try:
            self._check_space(4 * size)
            self._checkpoint()
            self._log_limit = LOG_LIMIT
        except PlatformError as error:  # no data is lost, and the next try may succeed
            self._log_limit = 2 * size
            log.warning("memory %s keeps a log of %d bytes: %s", self._path, size, error)

    def _checkpoint(self) -> None:
        self._files.make_private(*AT_CHECKPOINT)
        self._execute("CHECKPOINT")

    def _check_space(self, needed: int) -> None:
        """Refuse a write of `needed` bytes if the disk would be too full after it."""
        try:
            free = shutil.disk_usage(self._path.parent).free
        except OSError:
            return  # the write itself will report the problem
        if free < RESERVE + needed:
            why = f"the disk is full ({free // 2**20} MB free, {(RESERVE + needed) // 2**20 + 1} MB needed)"
            raise PlatformError(why_not_written(self._path, why))

    def _be_writable(self, size: int) -> None:
        """Prepare a write of `size` bytes of text. After a failed write, open the file again if the disk has room."""
        self._check_space(4 * size)
        if not self._stuck:
            self._files.make_private(".wal")
            return
        if not self._files.can_write():
            raise PlatformError(why_not_written(self._path, self._stuck))
        self._connection.close()
        self._database.close()
        self._stuck = ""
        self._open()

    def _get_stuck(self, said: str) -> None:
        """Stop all writes after a failed write, and cut its incomplete record off the log."""
        self._stuck = reason(said)
        with contextlib.suppress(OSError):
            os.truncate(self._files.log, self._log_good)  # an incomplete record would make the log look damaged
        # Keep these objects for ever: their garbage collection would end the process.
        for held in (self._connection, self._database):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(held))


def _decoded(value: Any) -> Any:
    """Return a node or relation as `Raw`; return any other value as it is."""
    if isinstance(value, dict) and "_LABEL" in value:
        found = cast("dict[str, Any]", value)
        label = found.get(NAME) if found["_LABEL"] == RELATION else str(found.get("id", "")).partition(":")[0]
        return Raw(str(label), found)
    return cast("Any", value)
