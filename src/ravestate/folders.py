"""The operating system's folders for a user's files, and a safe way to replace a file."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Literal


def user_folder(kind: Literal["data", "state", "cache"]) -> Path:
    """Return the path of Ravestate's folder for this user's files of one kind. The folder may not exist yet.

    Args:
        kind: ``data`` for files that must not be lost; ``state`` for files that are useful in the next session;
            ``cache`` for files that Ravestate can make again. On Windows, all kinds have the same folder. On macOS,
            ``data`` and ``state`` have the same folder.
    """
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / ("Caches" if kind == "cache" else "Application Support")
    else:
        given = os.environ.get(f"XDG_{kind.upper()}_HOME", "")  # the XDG standard ignores a relative path
        default = {"data": ".local/share", "state": ".local/state", "cache": ".cache"}[kind]
        base = Path(given) if Path(given).is_absolute() else Path.home() / default
    return base / "ravestate"


def replace_file(path: Path, content: bytes, *, mode: int = 0o666) -> None:
    """Write a file as a whole. If this fails, for example on a full disk, the file stays as it was.

    Args:
        path: The file.
        content: The new content.
        mode: The rights of the new file; the process's umask takes some of them away.

    Raises:
        OSError: The file cannot be written.
    """
    new = path.with_name(f"{path.name}.new")
    try:
        new.unlink(missing_ok=True)  # a process that died may have left this file, perhaps with other rights
        with os.fdopen(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as file:
            file.write(content)
        new.replace(path)
    except OSError:
        new.unlink(missing_ok=True)
        raise
