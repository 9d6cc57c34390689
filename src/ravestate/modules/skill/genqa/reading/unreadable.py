"""The exception for a file that cannot be read."""

from __future__ import annotations


class Unreadable(Exception):
    """A file that cannot be read; the message says why."""
