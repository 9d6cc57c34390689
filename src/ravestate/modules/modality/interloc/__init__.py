"""Who is there: the users that platforms see or hear."""

from __future__ import annotations

from typing import Any

import ravestate as rs

__all__ = ["module", "users"]

module = rs.Module("interloc")

users: rs.Collection[Any] = module.collection("users", input=True)
"""The users present: a key that the platform chooses, and the user's name, or None while it is unknown."""
