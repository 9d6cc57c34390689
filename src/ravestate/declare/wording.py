"""How messages name what a designer wrote: as it is typed, and where it stands."""

from __future__ import annotations

import sys

__all__ = ["place_of_call", "spelt"]

HERE = __file__.removesuffix("wording.py")


def spelt(name: str, home: str = "") -> str:
    """A qualified name as it is typed, seen from the module `home`, whose own names are variables there.

    Example:
        >>> spelt("rawio:input:changed", "guide"), spelt("guide:face", "guide")
        ('rawio.input.changed', 'face')
    """
    parts = name.split(":")
    return ".".join(parts[1:] if parts[0] == home else parts).replace("-", "_")


def place_of_call() -> str:
    """Where the nearest caller outside of this folder stands, ``file:line``."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]  # error messages say where the mistake is
    while frame.f_back is not None and frame.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"
