"""Greetings and goodbyes: when users come and go, and when they say hello or goodbye."""

from __future__ import annotations

from . import rules as rules
from .names import goodbye, hello, module, parted

__all__ = ["goodbye", "hello", "module", "parted"]
