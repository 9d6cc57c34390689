"""Simulated faults of the file in which chats keep their messages."""

import sqlite3
from typing import Any

import pytest

from ravestate.modules.platform.chats import Incoming, Store


def fill_disk(monkeypatch: pytest.MonkeyPatch, attempts: int = 2) -> list[Exception]:
    """Make the next attempts to store a message fail as on a full disk. Return the list of failures still to come."""
    take, failures = Store.take, list[Exception]([sqlite3.OperationalError("database or disk is full")] * attempts)

    def take_if_there_is_space(store: Store, message: Incoming) -> Any:
        if failures:
            raise failures.pop()
        return take(store, message)

    monkeypatch.setattr(Store, "take", take_if_there_is_space)
    return failures
