"""Greet users who come or greet, and say goodbye to users who leave or say goodbye."""

from __future__ import annotations

from . import rules as rules
from .names import goodbye, hello, module, parted

__all__ = ["goodbye", "hello", "module", "parted"]
