"""The generated pictures of the documentation match the code on its pages."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def pictures(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    spec = importlib.util.spec_from_file_location("pictures", ROOT / "tools" / "pictures.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "pictures", module)  # the decorator of dataclasses looks the module up there
    spec.loader.exec_module(module)
    return module


def test_the_pictures_are_up_to_date(pictures: ModuleType) -> None:
    assert pictures.stale() == [], "run: .venv/bin/python tools/pictures.py"


def test_each_picture_is_on_a_page_and_has_a_description(pictures: ModuleType) -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    for name, picture in pictures.pictures().items():
        assert f"pictures/{name})" in text
        assert ElementTree.fromstring(picture).find("{http://www.w3.org/2000/svg}title") is not None
