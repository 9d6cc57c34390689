"""Text for values and exceptions. Their `repr` and `str` are not our code, and may fail."""

from __future__ import annotations


def shown(value: object) -> str:
    """Return the value's `repr` or, if that fails, its type."""
    try:
        return repr(value)
    except Exception:  # the value's own code may raise anything, and the message is needed anyway
        return f"<{type(value).__name__} without a repr>"


def said(exception: BaseException) -> str:
    """Return the exception's message or, if that fails, its type."""
    try:
        return str(exception)
    except Exception:  # the exception's own code may raise anything, and the report is needed anyway
        return shown(exception)
