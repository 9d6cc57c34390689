"""A package can be blocked for one thread."""

import importlib
import sys
import threading

import pytest

from ravestate.modules.meta.nlp.blocking import blocked


@pytest.fixture(autouse=True)
def not_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)


def test_a_blocked_package_can_be_imported_later() -> None:
    finders = list(sys.meta_path)
    with blocked("colorsys"), pytest.raises(ModuleNotFoundError, match="colorsys is blocked here"):
        importlib.import_module("colorsys")
    assert importlib.import_module("colorsys").rgb_to_hsv
    assert sys.meta_path == finders


def test_other_threads_can_import_it() -> None:
    found: list[object] = []
    with blocked("colorsys"):
        thread = threading.Thread(target=lambda: found.append(importlib.import_module("colorsys")))
        thread.start()
        thread.join()
    assert len(found) == 1


def test_an_imported_package_stays_available() -> None:
    imported = importlib.import_module("colorsys")
    with blocked("colorsys"):
        assert importlib.import_module("colorsys") is imported
