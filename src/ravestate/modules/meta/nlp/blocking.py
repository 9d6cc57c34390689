"""Import a package without the optional packages that it would import."""

from __future__ import annotations

import sys
import threading
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType


class _BlockingFinder(MetaPathFinder):
    def __init__(self, names: frozenset[str]) -> None:
        self._names = names
        self._thread = threading.get_ident()

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname in self._names and threading.get_ident() == self._thread:
            raise ModuleNotFoundError(f"{fullname} is blocked here", name=fullname)
        return None


@contextmanager
def blocked(*names: str) -> Generator[None]:
    """Prevent this thread from importing the packages `names` for the first time. Other threads still can import them.

    Example:
        >>> with blocked("this"):
        ...     import this
        Traceback (most recent call last):
        ModuleNotFoundError: this is blocked here
    """
    finder = _BlockingFinder(frozenset(names))
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
