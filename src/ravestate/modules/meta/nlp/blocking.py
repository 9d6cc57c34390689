"""Import a package without some of its parts, and without optional packages that it would import."""

from __future__ import annotations

import sys
import threading
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any


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
    """In the ``with`` block, raise an error if this thread imports a package in `names` that is not imported yet.

    Other threads can import the package.

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


@contextmanager
def postponed(module: str, function: str) -> Generator[None]:
    """Replace `module` and its package by stubs during an import, so that they are not imported yet.

    The stub of the module has only `function`. A call of this function imports the real module. If the package is
    imported already, do nothing.

    Args:
        module: The module's full name.
        function: The only function of the module that the import needs.
    """
    package = module.rpartition(".")[0]
    if package in sys.modules:
        yield
        return

    def call(*args: Any, **options: Any) -> Any:
        return getattr(import_module(module), function)(*args, **options)

    for name in (package, module):
        sys.modules[name] = ModuleType(name)
    sys.modules[package].__path__ = []
    setattr(sys.modules[module], function, call)
    try:
        yield
    finally:
        for name in (package, module):
            sys.modules.pop(name, None)
