"""Each module offers the names that its README lists."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

from ravestate import modules

ROOT = Path(modules.__file__ or "").parent
READMES = sorted(ROOT.rglob("README.md"))


@pytest.mark.parametrize("readme", READMES, ids=lambda readme: readme.parent.name)
def test_a_module_offers_each_name_in_the_tables_of_its_readme(readme: Path) -> None:
    package = readme.parent
    offered = import_module("ravestate.modules." + ".".join(package.relative_to(ROOT).parts))
    rows = re.findall(rf"^\| ((?:`{package.name}\.\w+`(?:, )?)+) \|", readme.read_text(encoding="utf-8"), re.MULTILINE)
    names = {name for row in rows for name in re.findall(r"\.(\w+)`", row)}
    assert names <= set(offered.__all__)
