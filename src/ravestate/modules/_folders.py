"""The platform's folders for a user's files."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Literal


def user_folder(kind: Literal["data", "state"]) -> Path:
    """Return Ravestate's folder among the user's own; it may not exist yet.

    Args:
        kind: ``data`` for files that must not be lost, ``state`` for files that only outlast a session. Only the XDG
            base directory specification tells them apart.
    """
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        given = os.environ.get(f"XDG_{kind.upper()}_HOME", "")  # the standard ignores a relative path
        default = Path.home() / ".local" / ("share" if kind == "data" else "state")
        base = Path(given) if Path(given).is_absolute() else default
    return base / "ravestate"
