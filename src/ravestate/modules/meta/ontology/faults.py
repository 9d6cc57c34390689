"""What a user is told when ladybug fails."""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["is_failed_write", "is_torn_log", "reason", "why_not_opened"]

ELSE = "name another file with --set ontology.path=FILE"


def is_failed_write(said: str) -> bool:
    """Whether it could not write its log."""
    return "Cannot write to file" in said or "Cannot sync file" in said


def is_torn_log(said: str) -> bool:
    """Whether its log cannot be read to its end."""
    return "wal file" in said.lower()


def reason(said: str) -> str:
    """Why a write failed."""
    found = said.rpartition("Error: ")[2].strip().rstrip(".")
    # Where a part was written it tells of an error that is long past.
    return found if found not in ("", "Success", "No such file or directory") else "the disk is full"


def why_not_opened(path: Path, said: str) -> str:
    """Why a file cannot be opened, and what to do."""
    first = said.strip().splitlines()[0] if said.strip() else "no reason given"
    if "set lock" in said:
        held = re.search(r"PID (\d+)", said)
        who = f"process {held[1]}" if held else "another process"
        return (
            f"memory {path} is in use by {who}: only one process may have it open. End that agent, or {ELSE}"
        )
    if version := re.search(r"file version: (\d+), Current build storage version: (\d+)", said):
        newer = int(version[1]) > int(version[2])
        return (
            f"memory {path} was written by {'a newer' if newer else 'an older'} version of ladybug (format {version[1]}; this one "
            f"reads {version[2]}): "
            + ("pip install --upgrade ladybug" if newer else "export it with that one, and load it here")
            + f", or {ELSE}. Nothing was changed"
        )
    if "Cannot open file" in said or "directory" in said:
        return f"memory {path} cannot be opened ({first.rpartition(': ')[2] or first}): {ELSE}"
    return (
        f"memory {path} is broken, or no file of memory ({first}): move it away to begin anew, or put a copy of it in its "
        "place. Nothing was changed"
    )
