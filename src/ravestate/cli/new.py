"""``ravestate new``: a small project to start from, with tests that pass."""

from __future__ import annotations

import argparse
import keyword
import re
import shlex
import shutil
import sys
from importlib.resources import files
from pathlib import Path

from ravestate.errors import UsageError
from ravestate.loading.modules import LIBRARIES
from ravestate.modules import BUILT_IN

FILES = {
    "README.md": "README.md",
    "agent.yaml": "agent.yaml",
    "pyproject.toml": "pyproject.toml",
    "module.py": "{package}.py",
    "test_module.py": "tests/test_{package}.py",
}
"""Template → its path in the new project."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", help="the name of the project and of its new folder, e.g. my-agent")


def run(options: argparse.Namespace) -> int:
    folder = Path(options.name)
    name = folder.name
    package = name.replace("-", "_").lower()
    if not re.fullmatch(r"[A-Za-z]([A-Za-z0-9_-]*[A-Za-z0-9])?", name):  # pip accepts no other ending
        raise UsageError(
            f"{name!r} is not a name for a project: use letters, digits, '-' and '_', e.g. my-agent; begin with a letter, "
            "and end with a letter or digit"
        )
    if keyword.iskeyword(package):
        raise UsageError(f"{name!r} is a Python keyword: choose another name, e.g. my-{name}")
    if package in LIBRARIES or package in ("core", "pytest", "test", "tests", *BUILT_IN):
        raise UsageError(f"a module named {package!r} exists already: choose another name, e.g. my-{name}")
    templates = files("ravestate.cli") / "template"
    path = folder
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise UsageError(f"{folder} exists already, and is not empty")
        for template, target in FILES.items():
            text = (templates / f"{template}.txt").read_text(encoding="utf-8")
            path = folder / target.format(package=package)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text.replace("__name__", name).replace("__package__", package), encoding="utf-8")
            print(f"wrote {path}")
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None
    print(f"\nNow:\n  cd {shlex.quote(str(folder))}\n  {_named('ravestate')} run agent.yaml")
    print(f"  {_named('python')} -m pip install pytest\n  {_named('python')} -m pytest")
    return 0


def _named(command: str) -> str:
    """Return the name of a command of this Python environment, or its path if the shell would not find it."""
    place = Path(sys.executable).with_name(command)
    found = shutil.which(command)
    is_found = found is not None and Path(found) == place
    return command if is_found or not place.exists() else shlex.quote(str(place))
