"""Where memory is, by the settings, and how it is opened there."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.modules._folders import user_folder

from .memory import Memory
from .type_files import read_types
from .types import Types
from .worker import StoreWorker

if TYPE_CHECKING:
    from .names import Settings

__all__ = ["default_path", "open_memory", "path_of", "types_in", "types_of"]


def default_path(agent: str) -> Path:
    """The file of an agent's memory in the user's data folder."""
    return user_folder("data") / agent / "memory.lbug"


def types_of(settings: Settings) -> Types:
    """The types that come with the module, and the user's; see `types_in`."""
    return types_in(settings.types)


def types_in(paths: Iterable[Path]) -> Types:
    """The types that come with the module, and those of files. Files are read once, unless one has changed since.

    Raises:
        DeclarationError: A file is no file of types, or contradicts another.
        PlatformError: A file cannot be read.
    """
    return _read(tuple((path.expanduser(), _state_of(path.expanduser())) for path in paths))


@lru_cache(maxsize=8)  # each visitor of a page opens memory
def _read(own: tuple[tuple[Path, object], ...]) -> Types:
    built_in = files("ravestate.modules.meta.ontology") / "types.yaml"
    return read_types([built_in, *(path for path, _ in own)])


def _state_of(path: Path) -> object:
    """What tells whether a file has changed."""
    try:
        stat = path.stat()
    except OSError:  # which is said when it is read
        return None
    return stat.st_ino, stat.st_size, stat.st_mtime_ns


def path_of(settings: Settings) -> Path | None:
    """The file of memory, its links resolved; None where memory is on a server."""
    if settings.url is not None:
        return None
    return Path(os.path.realpath((settings.path or default_path(settings.agent)).expanduser()))


def open_memory(settings: Settings) -> Memory:
    """Begin to open memory where the settings say; all of it happens in memory's thread.

    What is wrong is raised by ``memory.opened()``.
    """

    def read() -> Types:
        return types_of(settings)

    path = path_of(settings)
    if path is None:
        return Memory(StoreWorker(str(settings.url), lambda: _server(settings)), read)
    return Memory(StoreWorker.shared(str(path), lambda: _file(path)), read)


def _file(path: Path) -> Any:
    from .embedded import EmbeddedStore

    return EmbeddedStore(path)


def _server(settings: Settings) -> Any:
    from .bolt import BoltStore

    assert settings.url is not None  # as asked for above
    password = "" if settings.password is None else settings.password.get_secret_value()
    return BoltStore(settings.url, settings.user, password, settings.database, settings.timeout)
