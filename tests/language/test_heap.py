"""Memory goes back to the system where that is possible; elsewhere the call does nothing."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest

from ravestate.language.heap import give_back, note_load


def test_the_c_library_returns_the_memory_once_for_each_load(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    class Library:
        def __init__(self, _: Any) -> None:
            self.malloc_trim = asked.append

    monkeypatch.setattr(ctypes, "CDLL", Library)
    note_load()
    give_back()
    give_back()
    assert asked == [0]


@pytest.mark.parametrize("error", [OSError, TypeError, AttributeError])
def test_another_system_keeps_the_memory(error: type[Exception], monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Any) -> None:
        raise error

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    note_load()
    give_back()
