"""`blocked` keeps one thread from importing a package. `postponed` delays an import until a function is called."""

import importlib
import sys
import threading
from pathlib import Path

import pytest

from ravestate.modules.meta.nlp.blocking import blocked, postponed


@pytest.fixture(autouse=True)
def not_imported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)


def test_a_blocked_package_can_be_imported_later() -> None:
    finders = list(sys.meta_path)
    with blocked("colorsys"), pytest.raises(ModuleNotFoundError, match="colorsys is blocked here"):
        importlib.import_module("colorsys")
    assert importlib.import_module("colorsys").rgb_to_hsv
    assert sys.meta_path == finders


def test_other_threads_can_import_a_blocked_package() -> None:
    found: list[object] = []
    with blocked("colorsys"):
        thread = threading.Thread(target=lambda: found.append(importlib.import_module("colorsys")))
        thread.start()
        thread.join()
    assert len(found) == 1


def test_a_package_that_is_already_imported_stays_available() -> None:
    imported = importlib.import_module("colorsys")
    with blocked("colorsys"):
        assert importlib.import_module("colorsys") is imported


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package that imports a function from its own subpackage."""
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "shop" / "office").mkdir(parents=True)
    (tmp_path / "shop" / "__init__.py").write_text("from .office.desk import write")
    (tmp_path / "shop" / "office" / "__init__.py").write_text("")
    (tmp_path / "shop" / "office" / "desk.py").write_text(
        "def write(text, *, loud): return text.upper() if loud else text"
    )
    for name in ("shop", "shop.office", "shop.office.desk"):
        monkeypatch.setitem(sys.modules, name, None)  # so that the test leaves nothing behind
        del sys.modules[name]


@pytest.mark.usefixtures("shop")
def test_a_postponed_function_imports_its_module_when_it_is_called() -> None:
    with postponed("shop.office.desk", "write"):
        shop = importlib.import_module("shop")
    assert "shop.office" not in sys.modules
    assert shop.write("tea", loud=True) == "TEA"
    assert "shop.office.desk" in sys.modules


@pytest.mark.usefixtures("shop")
def test_an_imported_module_is_not_postponed() -> None:
    desk = importlib.import_module("shop.office.desk")
    with postponed("shop.office.desk", "write"):
        assert sys.modules["shop.office.desk"] is desk
    assert sys.modules["shop.office.desk"] is desk
