"""Free memory is returned to the operating system if the C library can do this."""

from __future__ import annotations

import ctypes
import threading
from typing import Any

import pytest

from ravestate.language import heap
from ravestate.language.heap import give_back, keep_few_heaps, note_load


def test_free_memory_is_returned_to_the_system_after_a_load(monkeypatch: pytest.MonkeyPatch) -> None:
    returned = threading.Event()

    class Library:
        def __init__(self, _: Any) -> None:
            pass

        def malloc_trim(self, kept: int) -> None:
            assert kept == 0
            returned.set()

    monkeypatch.setattr(ctypes, "CDLL", Library)
    monkeypatch.setattr(heap, "SETTLED", 0.0)
    note_load()
    assert returned.wait(60)


def test_a_second_load_delays_the_return_of_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    def timer_of_a_load() -> threading.Timer:
        before = set(threading.enumerate())
        note_load()
        [timer] = set(threading.enumerate()) - before
        assert isinstance(timer, threading.Timer)
        return timer

    monkeypatch.setattr(heap, "SETTLED", 3600.0)
    first = timer_of_a_load()
    second = timer_of_a_load()
    assert first.finished.is_set()  # the second load has cancelled the first timer
    assert second.is_alive() and second.daemon
    second.cancel()


def test_environment_variables_of_malloc_take_precedence(monkeypatch: pytest.MonkeyPatch) -> None:
    chosen: list[tuple[int, int]] = []

    class Library:
        def __init__(self, _: Any) -> None:
            pass

        def mallopt(self, option: int, value: int) -> None:
            chosen.append((option, value))

    monkeypatch.setattr(ctypes, "CDLL", Library)
    for name in ("MALLOC_ARENA_MAX", "MALLOC_MMAP_THRESHOLD_"):
        monkeypatch.delenv(name, raising=False)
    keep_few_heaps()
    assert chosen == [(-8, 2), (-3, 2**19)]
    chosen.clear()
    monkeypatch.setenv("MALLOC_MMAP_THRESHOLD_", "1000000")
    keep_few_heaps()
    assert chosen == [(-8, 2)]


@pytest.mark.parametrize("error", [OSError, TypeError, AttributeError])
def test_with_another_c_library_the_functions_do_nothing(
    error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: Any) -> None:
        raise error

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    give_back()
    keep_few_heaps()
