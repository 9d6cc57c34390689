"""The messages that users get when ladybug fails (the embedded graph database)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

ELSE = "name another file with --set ontology.path=FILE"
ENDS_PROCESS = "reading the file crashes the process"

_NO_DAMAGE = re.compile(r"set lock|file version: |Cannot open file|directory")
_DAMAGE = re.compile(
    r"corrupt|bad_alloc|Assertion failed|out of bounds|^(?:Runtime|Storage|Internal) exception", re.IGNORECASE
)


def said_by(error: BaseException) -> str:
    """Return the message of an exception, or the name of its type if the message is empty."""
    return str(error).strip() or type(error).__name__


def is_failed_write(said: str) -> bool:
    """Return whether a message of ladybug means that it could not write its log."""
    return "Cannot write to file" in said or "Cannot sync file" in said


def is_foreign_log(said: str) -> bool:
    """Return whether a message of ladybug means that the log belongs to another database, e.g. a deleted one."""
    return "does not match" in said and "Database ID" in said


def is_about_log(said: str) -> bool:
    """Return whether the message of a failed opening may mean that the log is damaged."""
    return _NO_DAMAGE.search(said) is None


def is_damage(error: BaseException) -> bool:
    """Return whether a statement failed because of a damaged file. Damaged pages can raise almost any exception."""
    return not isinstance(error, RuntimeError) or _DAMAGE.search(str(error)) is not None


def reason(said: str) -> str:
    """Return the reason for a failed write, from ladybug's message."""
    found = said.rpartition("Error: ")[2].strip().rstrip(".")
    # After a partial write, ladybug reports an outdated reason. The real reason is a full disk.
    return found if found not in ("", "Success", "No such file or directory") else "the disk is full"


def why_not_written(path: Path, why: str) -> str:
    """Return the message for users about a failed write."""
    room = "Make room on the disk; saved data is safe, and memory works again once there is room"
    return f"memory {path} cannot be written: {why}. {room}"


def why_broken(path: Path, said: str, files: Iterable[Path]) -> str:
    """Return the message for users about a damaged memory; it names all files of the memory."""
    first = (said.splitlines() or [""])[0][:200]
    return (
        f"memory {path} is damaged, or is not a memory file ({first}): replace it with a backup copy, or remove "
        f"{', '.join(file.name for file in files)} with ravestate memory reset --path {path}"
    )


def why_not_opened(path: Path, said: str, files: Iterable[Path]) -> str:
    """Return the message for users about a file that cannot be opened, with the reason and the remedy."""
    first = said.strip().splitlines()[0] if said.strip() else "no reason given"
    if "set lock" in said:
        held = re.search(r"PID (\d+)", said)
        who = f"process {held[1]}" if held else "another process"
        return f"memory {path} is in use by {who}: only one process may have it open. End that agent, or {ELSE}"
    if version := re.search(r"file version: (\d{1,3}), Current build storage version: (\d+)", said):
        newer = int(version[1]) > int(version[2])
        return (
            f"memory {path} was written by {'a newer' if newer else 'an older'} version of ladybug (format {version[1]}; this one "
            f"reads {version[2]}): "
            + ("pip install --upgrade ladybug" if newer else "export it with that version and import it with this one")
            + f", or {ELSE}. Nothing was changed"
        )
    if "Cannot open file" in said or "directory" in said:
        return f"memory {path} cannot be opened ({first.rpartition(': ')[2] or first}): {ELSE}"
    return why_broken(path, said, files) + ". Nothing was changed"
