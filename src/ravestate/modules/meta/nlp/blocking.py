"""Importing a package without what it would take along."""

from __future__ import annotations

import sys
import threading
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

__all__ = ["hidden"]


class _Hider(MetaPathFinder):
    def __init__(self, names: frozenset[str]) -> None:
        self._names = names
        self._thread = threading.get_ident()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname in self._names and threading.get_ident() == self._thread:
            raise ModuleNotFoundError(f"{fullname} is hidden here", name=fullname)
        return None


@contextmanager
def hidden(*names: str) -> Generator[None]:
    """Within, this thread cannot import the packages `names`, unless they are imported already; other threads can.

    Example:
        >>> with hidden("this"):
        ...     import this
        Traceback (most recent call last):
        ModuleNotFoundError: this is hidden here
    """
    hider = _Hider(frozenset(names))
    sys.meta_path.insert(0, hider)
    try:
        yield
    finally:
        sys.meta_path.remove(hider)
