"""The compiled build. ``tools/native.py`` compiles the Python files whose code handles every event.

The compiled files are in ``native``, which has a folder for each interpreter and platform. `prefer` makes a package
import the compiled files for this interpreter instead of their sources. The file ``stamp`` beside these files has the
checksum that the sources had when they were compiled. If the sources have changed since, or if the environment variable
``RAVESTATE_PURE`` is not empty, the sources run as pure Python.
"""

from __future__ import annotations

import os
import sys
import zlib
from collections.abc import Iterable, MutableSequence
from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES

SOURCES = os.path.dirname(__file__)
PLACE = os.path.join(SOURCES, "native", EXTENSION_SUFFIXES[0].split(".")[1])
"""The folder of the compiled modules for this interpreter, e.g. ``native/cpython-311-x86_64-linux-gnu``."""
STAMP = os.path.join(PLACE, "stamp")
"""A text file: the checksum of the sources that were compiled, and then their names, one on each line."""

COMPILED = "compiled"
PURE = "pure Python"
STALE = "pure Python: the sources have changed since they were compiled"


def checksum(names: Iterable[str]) -> str:
    """Return a checksum of source files; their names are relative to the package's folder."""
    found = 0
    for name in names:
        with open(os.path.join(SOURCES, name), "rb") as file:
            found = zlib.crc32(file.read(), found)
    return f"{found:08x}"


@cache
def build() -> str:
    """Return which build runs: `COMPILED`, `PURE` or `STALE`."""
    if os.environ.get("RAVESTATE_PURE"):
        return PURE
    try:
        with open(STAMP, encoding="utf-8") as file:
            compiled, *names = file.read().split()
        fresh = checksum(names) == compiled
    except OSError:
        return PURE
    if not fresh:
        return STALE
    sys.modules["ravestate"].__path__.append(PLACE)  # the compiled files share one library in this folder
    return COMPILED


def prefer(path: MutableSequence[str]) -> None:
    """If the compiled build runs, make a package import its compiled files. `path` is the package's ``__path__``."""
    if build() == COMPILED:
        path.insert(0, os.path.join(PLACE, os.path.basename(path[0])))
