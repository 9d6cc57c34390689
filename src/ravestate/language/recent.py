"""Keep the latest results of a function."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import TypeVar

Key = TypeVar("Key")
Value = TypeVar("Value")


def keep_latest(kept: dict[Key, Value], new: Mapping[Key, Value], most: int) -> None:
    """Add `new` to `kept` as the latest entries. If `kept` then has more than `most` entries, drop the oldest ones."""
    for key, value in new.items():
        kept.pop(key, None)
        kept[key] = value
    for key in list(islice(kept, max(0, len(kept) - most))):
        del kept[key]
