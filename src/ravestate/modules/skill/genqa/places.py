"""The path of the index, and the `Answerer` that all contexts with the same settings share."""

from __future__ import annotations

import threading
from pathlib import Path

from ravestate.folders import user_folder

from .answering import Answerer
from .names import Settings

_answerers: dict[tuple[Path, bool, Path | None], Answerer] = {}
_making = threading.Lock()


def path_of(settings: Settings) -> Path:
    """Return the file of the index: from the settings, or in the user's data folder."""
    if settings.index is not None:
        return settings.index.expanduser().absolute()
    return user_folder("data") / "genqa.sqlite"


def answerer_of(settings: Settings) -> Answerer:
    """Return the answerer for these settings. All contexts of the process with the same settings share it."""
    key = (path_of(settings), settings.collection, settings.reader)
    with _making:
        if key not in _answerers:
            _answerers[key] = Answerer(key[0], collection=key[1], reranker=key[2])
        return _answerers[key]
