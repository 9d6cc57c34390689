"""The operating system's folders for a user's files."""

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
