"""Functions that open the agent's long-term memory. The settings name its place: a file or a server."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ravestate.folders import user_folder

from .memory import Memory
from .names import Settings
from .type_files import types_in
from .types import Types
from .worker import StoreWorker


def default_path(agent: str) -> Path:
    """Return the path of an agent's memory file in the user's data folder."""
    return user_folder("data") / agent / "memory.lbug"


def types_of(settings: Settings) -> Types:
    """Return the built-in types and the types in the files that the settings name; see `types_in`."""
    return types_in(settings.types)


def path_of(settings: Settings) -> Path | None:
    """Return the path of the memory file, with symbolic links resolved, or None for a memory on a server."""
    if settings.url is not None:
        return None
    return Path(os.path.realpath((settings.path or default_path(settings.agent)).expanduser()))


def open_memory(settings: Settings) -> Memory:
    """Start to open memory in another thread. Return the memory immediately.

    If memory cannot be opened, ``await memory.opened()`` raises the error.
    """

    path = path_of(settings)
    if path is None:
        worker = StoreWorker(str(settings.url), lambda: _server(settings))
    else:
        worker = StoreWorker.shared(str(path), lambda: _file(path))
    return Memory(worker, lambda: types_of(settings))


def _file(path: Path) -> Any:
    from .embedded import EmbeddedStore

    return EmbeddedStore(path)


def _server(settings: Settings) -> Any:
    from .bolt import BoltStore

    assert settings.url is not None  # `open_memory` has checked that there is a URL
    password = "" if settings.password is None else settings.password.get_secret_value()
    return BoltStore(settings.url, settings.user, password, settings.database, settings.timeout)
