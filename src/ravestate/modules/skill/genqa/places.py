"""Where the index is, and who answers from it."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from .answering import Answerer

if TYPE_CHECKING:
    from . import Settings

__all__ = ["answerer_of", "path_of"]

_answerers: dict[tuple[Path, bool, Path | None], Answerer] = {}
_making = threading.Lock()


def path_of(settings: Settings) -> Path:
    """The file of the index: what the settings say, or one in the user's data folder, as the platform has it."""
    if settings.index is not None:
        return settings.index.expanduser().absolute()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Application Support"
    else:
        given = os.environ.get("XDG_DATA_HOME", "")  # a relative one does not count, says its standard
        base = Path(given) if Path(given).is_absolute() else Path.home() / ".local" / "share"
    return base / "ravestate" / "genqa.sqlite"


def answerer_of(settings: Settings) -> Answerer:
    """Who answers by these settings: one for all contexts of the process."""
    key = (path_of(settings), settings.collection, settings.reader)
    with _making:
        if key not in _answerers:
            _answerers[key] = Answerer(key[0], collection=key[1], reranker=key[2])
        return _answerers[key]
