"""The files of a memory: the database, its log, and the files that a crash may leave beside them."""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
from collections.abc import Iterable
from pathlib import Path

AT_CHECKPOINT = (".shadow", ".checkpoint.intent.lock", ".checkpoint.apply.lock")
"""The files that ladybug creates while it moves its log into the database."""

_SIDE_FILE = re.compile(
    r"(?P<new>\.new)?(\.wal(\.checkpoint)?|\.shadow|\.checkpoint\.(intent|apply)\.lock|\.tmp\..+)?(?P<kept>\.(damaged|orphaned)-\d+)?"
    r"|\.probe|\.sum"
)


class MemoryFiles:
    """The database file at a path, and its side files, such as the log.

    All these files contain personal data, so only the user may read them.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.log = self.beside(".wal")
        self.probe = self.beside(".probe")
        self._sum = self.beside(".sum")

    def beside(self, suffix: str) -> Path:
        """Return the path of the side file with this suffix."""
        return self.path.with_name(self.path.name + suffix)

    def present(self) -> list[Path]:
        """Return the files of the memory that exist, the database first."""
        try:
            files = sorted(self.path.parent.iterdir())
        except OSError:
            return []
        return [file for file in files if self._match(file) and file.is_file()]

    def kept(self) -> list[Path]:
        """Return the existing files that were set aside: damaged logs, and orphaned logs (of a deleted database)."""
        return [file for file in self.present() if (match := self._match(file)) and match["kept"]]

    def logs(self) -> list[Path]:
        """Return the side files that have data, except the checksum, and except logs that were set aside."""
        others = {self.path, self.probe, self._sum, *self.kept()}
        return [file for file in self.present() if file not in others and file.stat().st_size]

    def log_size(self) -> int:
        """Return the size of the write-ahead log in bytes; 0 if there is no log."""
        try:
            return self.log.stat().st_size
        except OSError:
            return 0

    def can_write(self) -> bool:
        """Return whether the system allows a file that is 1 MB longer than the log. To find out, write one."""
        try:
            with self.probe.open("wb") as file:
                file.truncate(self.log_size())
                file.seek(0, os.SEEK_END)
                file.write(bytes(2**20))
                file.flush()
                os.fsync(file.fileno())
            return True
        except OSError:
            return False
        finally:
            self.probe.unlink(missing_ok=True)

    def has_database(self) -> bool:
        """Return whether there is a database. An empty file does not count: a crash during creation leaves one."""
        return self.path.exists() and (not self.path.is_file() or self.path.stat().st_size > 0)

    def make_private(self, *suffixes: str) -> None:
        """Create missing files with these suffixes, which only the user can read. Ladybug would let everybody read them."""
        for suffix in suffixes:
            with contextlib.suppress(OSError):  # ladybug will report the problem
                os.close(os.open(self.beside(suffix), os.O_CREAT | os.O_RDWR, 0o600))

    def restrict(self) -> None:
        """Make all existing files of the memory readable only by the user."""
        for file in self.present():
            with contextlib.suppress(OSError):  # the file may belong to another user
                file.chmod(0o600)

    def set_aside(self, files: Iterable[Path], word: str) -> list[Path]:
        """Rename files to ``<name>.<word>-<number>``, and return their new paths."""
        moved: list[Path] = []
        for file in files:
            number = 1
            while (target := file.with_name(f"{file.name}.{word}-{number}")).exists():
                number += 1
            moved.append(file.rename(target))
        return moved

    def in_use(self) -> bool:
        """Return whether another process has the database open.

        On Windows, return False: the system itself refuses to remove a file in use.
        """
        try:
            import fcntl

            with self.path.open("r+b") as file:
                fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except (ImportError, OSError):
            return False
        return False

    def remove(self) -> list[Path]:
        """Remove all files of the memory, and return their paths."""
        return [file for file in self.present() if file.unlink(missing_ok=True) is None]

    def remove_rewrite(self) -> None:
        """Remove an unfinished rewrite: an incomplete copy of the database. The database itself is complete."""
        for file in self.present():
            if (match := self._match(file)) and match["new"] and not match["kept"]:
                file.unlink(missing_ok=True)

    def remove_empty(self) -> None:
        """Remove empty side files of ladybug."""
        for suffix in (".wal", *AT_CHECKPOINT):
            file = self.beside(suffix)
            with contextlib.suppress(OSError):
                if file.stat().st_size == 0:
                    file.unlink()

    # ------------------------------------------------------------------------------------ the checksum

    def seal(self) -> None:
        """Write the database's checksum beside it, after an orderly close."""
        with contextlib.suppress(OSError):  # without the checksum, the next opening takes longer
            self.make_private(".sum")
            self._sum.write_text(self._checksum(), encoding="ascii")

    def is_sealed(self) -> bool:
        """Return whether the database has not changed since `seal`, and has no log to read."""
        try:
            return not self.log_size() and self._sum.read_text(encoding="ascii") == self._checksum()
        except (OSError, ValueError):
            return False

    def _checksum(self) -> str:
        with self.path.open("rb") as file:
            return hashlib.file_digest(file, "blake2b").hexdigest()

    def _match(self, file: Path) -> re.Match[str] | None:
        name = self.path.name
        return _SIDE_FILE.fullmatch(file.name.removeprefix(name)) if file.name.startswith(name) else None
