"""Where the index is, and who answers from it."""

from __future__ import annotations

import threading
from pathlib import Path

from ravestate.modules._folders import user_folder

from .answering import Answerer
from .names import Settings

__all__ = ["answerer_of", "path_of"]

_answerers: dict[tuple[Path, bool, Path | None], Answerer] = {}
_making = threading.Lock()


def path_of(settings: Settings) -> Path:
    """The file of the index: what the settings say, or one in the user's data folder."""
    if settings.index is not None:
        return settings.index.expanduser().absolute()
    return user_folder("data") / "genqa.sqlite"


def answerer_of(settings: Settings) -> Answerer:
    """Who answers by these settings: one for all contexts of the process."""
    key = (path_of(settings), settings.collection, settings.reader)
    with _making:
        if key not in _answerers:
            _answerers[key] = Answerer(key[0], collection=key[1], reranker=key[2])
        return _answerers[key]
