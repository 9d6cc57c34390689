"""Where a user's files are kept, as the platform has it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Literal

__all__ = ["user_folder"]


def user_folder(kind: Literal["data", "state"]) -> Path:
    """Return Ravestate's folder among the user's own, which may not be there yet.

    Args:
        kind: ``data``: what must not be lost; ``state``: what is merely kept from session to session. Only the XDG
            base directory specification tells them apart.
    """
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        given = os.environ.get(
            f"XDG_{kind.upper()}_HOME", ""
        )  # a relative one does not count, says its standard
        default = Path.home() / ".local" / ("share" if kind == "data" else "state")
        base = Path(given) if Path(given).is_absolute() else default
    return base / "ravestate"
