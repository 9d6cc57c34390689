"""The wording of messages: names as a designer types them, places in the code, and values cut to a readable length."""

from __future__ import annotations

import sys
from collections.abc import Iterable

LENGTH = 60  # the maximum number of characters of a value in a message

HERE = __file__.removesuffix("wording.py")
CORE = HERE + "core.py"  # the only file in this folder that declares signals


def spelt(name: str, home: str = "") -> str:
    """Return a qualified name as Python code: ``rawio.output``, or just ``output`` if `home` is the name's module."""
    parts = name.split(":")
    if parts[0] == "core":
        parts[0] = "rs"
    return ".".join(parts[1:] if parts[0] == home else parts).replace("-", "_")


def place_of_call() -> str:
    """Return the place of the nearest caller outside this folder, or in ``core.py``, as ``file:line``."""
    frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage]  # messages show the line of the mistake
    while frame.f_back is not None and frame.f_code.co_filename.startswith(HERE):
        if frame.f_code.co_filename == CORE:
            break
        frame = frame.f_back
    return f"{frame.f_code.co_filename}:{frame.f_lineno}"


def shown(value: object) -> str:
    """Return the `repr` of a value; if the `repr` fails, return a text with the name of its type."""
    try:
        return repr(value)
    except Exception:  # the value's own `__repr__` may raise anything, and the message must still appear
        return f"<{type(value).__name__} without a repr>"


def said(exception: BaseException) -> str:
    """Return the message of an exception, or its `repr` if it has no message or if making the message fails."""
    try:
        return str(exception) or shown(exception)
    except Exception:  # the exception's `__str__` may raise anything, and the message must still appear
        return shown(exception)


def cut(text: str, length: int = LENGTH) -> str:
    """Return the text, shortened to `length` characters if it is longer; a shortened text ends in three dots."""
    return text if len(text) <= length else text[: length - 3] + "..."


def short(value: object, length: int = LENGTH) -> str:
    """Return the `repr` of a value, cut to `length` characters."""
    return cut(shown(value), length)


SHOWN = 8  # the number of names that a long list shows


def few(names: Iterable[str]) -> str:
    """Join distinct names with commas. If there are more than nine, show eight, and say how many more there are."""
    found = list(dict.fromkeys(names))
    more = len(found) - SHOWN
    if more <= 1:  # one more name is as short as "and 1 more"
        return ", ".join(found)
    return f"{', '.join(found[:SHOWN])} and {more} more"
