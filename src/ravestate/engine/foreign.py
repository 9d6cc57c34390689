"""What a designer's values and exceptions say of themselves: foreign code, which may fail while it does."""

from __future__ import annotations

__all__ = ["said", "shown"]


def shown(value: object) -> str:
    """The value's `repr`, or, if that fails, what it is."""
    try:
        return repr(value)
    except Exception:  # any value's own code may raise anything, and a message about it must still be told
        return f"<{type(value).__name__} without a repr>"


def said(exception: BaseException) -> str:
    """The exception's message, or, if that fails, what it is."""
    try:
        return str(exception)
    except Exception:  # any exception's own code may raise anything, and the failure must still be told
        return shown(exception)
