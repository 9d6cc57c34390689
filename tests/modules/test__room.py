"""Room that is given back: wherever that is possible, and without a word where it is not."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest

from ravestate.modules._room import give_back


def test_it_is_asked_of_the_c_library(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    class Library:
        def __init__(self, _: Any) -> None:
            self.malloc_trim = asked.append

    monkeypatch.setattr(ctypes, "CDLL", Library)
    give_back()
    assert asked == [0]


@pytest.mark.parametrize("error", [OSError, TypeError, AttributeError])
def test_another_system_is_let_be(error: type[Exception], monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Any) -> None:
        raise error

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    give_back()
