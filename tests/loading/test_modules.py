"""A module can be loaded by its file. `tests/cli/test_agent.py` tests the other ways, and every mistake."""

import importlib
import sys
from pathlib import Path

import pytest

from ravestate.errors import UsageError
from ravestate.loading.modules import load_module

MODULE = "import ravestate as rs\nmodule = rs.Module('shop')\n"


def test_a_file_that_a_test_has_imported_is_not_loaded_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "shop_of_the_test.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    imported = importlib.import_module("shop_of_the_test")
    assert load_module("./shop_of_the_test.py", tmp_path) is imported.module


def test_a_file_of_the_same_name_elsewhere_is_another_module(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "shop_of_two.py").write_text(MODULE, encoding="utf-8")
    first = load_module("shop_of_two.py", tmp_path / "one")
    assert load_module("shop_of_two.py", tmp_path / "two") is not first


@pytest.mark.parametrize("name", ["queue", "email", "ravestate", "yaml"])
def test_a_file_that_would_replace_a_library_is_refused(name: str, tmp_path: Path) -> None:
    library = importlib.import_module(name)
    (tmp_path / f"{name}.py").write_text(MODULE, encoding="utf-8")
    with pytest.raises(UsageError, match=rf"\./{name}\.py would replace .* rename the file, e\.g\. my_{name}\.py"):
        load_module(f"./{name}.py", tmp_path)
    assert sys.modules[name] is library
