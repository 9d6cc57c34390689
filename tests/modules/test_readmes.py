"""Each module offers the names that its README lists, and its README lists the names that it offers."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import ravestate as rs
from ravestate import modules

ROOT = Path(modules.__file__ or "").parent
READMES = sorted(ROOT.rglob("README.md"))
COMMON = {"module", "rules", "Settings"}
"""The names that almost every module offers. A README explains the settings one by one."""

each_readme = pytest.mark.parametrize("readme", READMES, ids=lambda readme: readme.parent.name)


def package_of(readme: Path) -> ModuleType:
    return import_module("ravestate.modules." + ".".join(readme.parent.relative_to(ROOT).parts))


@each_readme
def test_a_module_offers_each_name_in_the_tables_of_its_readme(readme: Path) -> None:
    package = readme.parent
    rows = re.findall(rf"^\| ((?:`{package.name}\.\w+`(?:, )?)+) \|", readme.read_text(encoding="utf-8"), re.MULTILINE)
    names = {name for row in rows for name in re.findall(r"\.(\w+)`", row)}
    assert names <= set(package_of(readme).__all__)


@each_readme
def test_a_readme_lists_each_name_that_its_module_offers(readme: Path) -> None:
    """Signals and slots have the name of their module before them; of other names, a mention in a sentence suffices."""
    package = package_of(readme)
    text = re.sub(r"^```.*?^```", "", readme.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    spans = re.findall(r"`([^`\n]+)`", text)
    words = {word for span in spans for word in re.findall(r"\w+", span)}
    missing: list[str] = []
    for name in sorted(set(package.__all__) - COMMON):
        qualified = isinstance(getattr(package, name), (rs.Signal, rs.Slot))
        if (f"{readme.parent.name}.{name}" not in spans) if qualified else (name not in words):
            missing.append(name)
    assert not missing
