"""The rules of a spoken conversation."""

from __future__ import annotations
