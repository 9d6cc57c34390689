"""The layers of the source: which package may import which.

`pyproject.toml` has the order of the layers as an import-linter contract. This file
proves the rest from the source itself: imports of the standard library, and of modules that `ravestate.modules` loads on
first use.
"""

import ast
import functools
import subprocess
import sys
from collections.abc import Iterable, Iterator
from graphlib import TopologicalSorter
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import NamedTuple

import pytest

from ravestate.declare.module import Module
from ravestate.modules import BUILT_IN
from ravestate.policy.components import components

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "ravestate"
KINDS = ("platform", "modality", "meta", "skill")

PURE_PACKAGES = ("declare", "policy", "draw", "engine", "errors.py")
PURE_LIBRARY = {
    "__future__", "abc", "array", "ast", "bisect", "collections", "contextlib", "copy", "dataclasses", "difflib", "dis",
    "enum", "fractions", "functools", "graphlib", "hashlib", "heapq", "html", "inspect", "itertools", "json",
    "keyword", "linecache", "math", "numbers", "operator", "re", "reprlib", "string", "struct", "sys", "textwrap",
    "traceback", "types", "typing", "unicodedata", "weakref",
    "xml.sax.saxutils", "zlib",
}  # fmt: skip
"""The modules of the standard library that pure packages may import.

Never add clocks, event loops, threads, random numbers, files or logs.
"""


def files_of(*packages: str) -> list[Path]:
    found: list[Path] = []
    for package in packages:
        place = SOURCE / package
        found += [place] if place.is_file() else sorted(place.rglob("*.py"))
    return found


class Import(NamedTuple):
    """An import, at the top of a file or inside a function: its absolute module, and the names taken from it."""

    line: int
    module: str
    names: tuple[str, ...]


@functools.cache
def imports_in(file: Path, *, typing: bool = False) -> list[Import]:
    """Return the imports of a file; with `typing`, also those for type checkers."""
    package = ("ravestate", *file.relative_to(SOURCE).parent.parts)

    def visit(node: ast.AST) -> Iterator[Import]:
        children: Iterable[ast.AST] = ast.iter_child_nodes(node)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            children = [*(node.body if typing else []), *node.orelse]
        elif isinstance(node, ast.Import):
            yield from (Import(node.lineno, alias.name, ()) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            origin = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*origin, *([node.module] if node.module else [])))
            yield Import(node.lineno, module, tuple(alias.name for alias in node.names))
        for child in children:
            if isinstance(child, (ast.stmt, ast.ExceptHandler, ast.match_case)):  # an expression contains no import
                yield from visit(child)

    return list(visit(ast.parse(file.read_text(encoding="utf-8"), str(file))))


def path_of(file: Path) -> str:
    return file.relative_to(SOURCE).as_posix()


def test_packages_import_only_packages_of_lower_layers() -> None:
    run = subprocess.run(
        [Path(sys.executable).with_name("lint-imports"), "--no-cache"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize("file", files_of(*PURE_PACKAGES), ids=path_of)
def test_pure_packages_import_nothing_impure(file: Path) -> None:
    impure = [
        f"{path_of(file)}:{line}: {module}"
        for line, module, _ in imports_in(file)
        if not {module, module.partition(".")[0]} & {"ravestate", *PURE_LIBRARY}
    ]
    assert not impure, "\n".join(impure)


def test_nothing_imports_the_command_line() -> None:
    guilty = [
        f"{path_of(file)}:{line}: {module}"
        for file in files_of(".")
        if not (path_of(file).startswith("cli/") or path_of(file) == "__main__.py")
        for line, module, names in imports_in(file)
        if f"{module}.".startswith("ravestate.cli.") or (module == "ravestate" and "cli" in names)
    ]
    assert not guilty, "\n".join(guilty)


def test_skills_do_not_import_platforms() -> None:
    platforms = {place.stem for place in (SOURCE / "modules" / "platform").glob("[!_]*")}
    guilty = [
        f"{path_of(file)}:{line}: {module} {', '.join(names)}"
        for file in files_of("modules/skill")
        for line, module, names in imports_in(file)
        if (lazy := module == "ravestate.modules" and platforms.intersection({*names, "platform"}))
        or lazy
        or f"{module}.".startswith("ravestate.modules.platform.")
        or module.removeprefix("ravestate.modules.") in platforms
    ]
    assert not guilty, "\n".join(guilty)


def test_every_module_is_a_folder_with_an_init_file_and_a_readme() -> None:
    missing = [
        f"modules/{kind}/{place.name}: no {wanted}"
        for kind in KINDS
        for place in sorted((SOURCE / "modules" / kind).glob("[!_]*"))
        for wanted in ("__init__.py", "README.md")
        if not (place / wanted).is_file()
    ]
    assert not missing, "\n".join(missing)


def test_a_runner_is_used_only_by_its_methods() -> None:
    guilty = [
        f"{path_of(file)}:{node.lineno}: {ast.unparse(node)}"
        for file in files_of(".")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute)
        for owner in (ast.unparse(node.value),)
        if (
            # No other object sets an attribute of a runner, or uses its private ones.
            (owner.endswith("runner") and (isinstance(node.ctx, ast.Store) or node.attr.startswith("_")))
            or (node.attr == "_runner" and owner != "self")
            # The helpers for tests use only what is public.
            or (path_of(file).startswith("testing/") and node.attr.startswith("_") and owner not in ("self", "timer"))
        )
        and not node.attr.startswith("__")
    ]
    assert not guilty, "\n".join(guilty)


@pytest.mark.parametrize("name", BUILT_IN)
def test_a_module_declares_its_names_before_its_rules(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """`names.py` declares all signals and slots and no rule. A module has `rules.py` if, and only if, it has rules."""
    package = import_module(f"ravestate.modules.{BUILT_IN[name]}.{name}")
    place = SOURCE / "modules" / BUILT_IN[name] / name
    spec = spec_from_file_location(f"{package.__name__}.names_alone", place / "names.py")
    assert spec is not None and spec.loader is not None
    names = module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, names)
    spec.loader.exec_module(names)
    module: Module = package.module
    assert list(map(str, names.module.signals + names.module.slots)) == list(map(str, module.signals + module.slots))
    assert names.module.rules == []
    assert bool(module.rules) == (place / "rules.py").is_file()


def test_imports_form_no_circle() -> None:
    """Imports inside functions count: a circle that closes later is a circle, too."""
    TopologicalSorter(import_graph()).prepare()  # raises a CycleError that names the files


def test_circles_of_types_have_at_most_three_files() -> None:
    """Records may refer to each other, as a group and its members do. With more than three files, no file stands alone."""
    graph = import_graph(typing=True)
    names = list(graph)
    numbers = {name: number for number, name in enumerate(names)}
    found = components([[numbers[target] for target in graph[name]] for name in names])
    large = [", ".join(names[member] for member in members) for members in found.members if len(members) > 3]
    assert not large, "\n".join(large)


def import_graph(*, typing: bool = False) -> dict[str, list[str]]:
    """Return the modules of the source that each module imports.

    ``from ravestate.modules import rawio`` counts as an import of the package of `rawio`, which that line loads.
    """
    files = {module_name(file): file for file in sorted(SOURCE.rglob("*.py"))}
    lazy = {f"ravestate.modules.{file.parent.name}": name for name, file in files.items() if is_built_in(file)}
    graph: dict[str, list[str]] = {}
    for name, file in files.items():
        targets = [
            target
            for _, module, names in imports_in(file, typing=typing and name != "ravestate.modules")
            for full in ([f"{module}.{each}" for each in names] or [module])
            for target in [lazy.get(full, full if full in files else module)]
            if target in files and target != name
        ]
        graph[name] = list(dict.fromkeys(targets))
    return graph


def is_built_in(file: Path) -> bool:
    """Return whether a file is the package of a built-in module."""
    return file.name == "__init__.py" and file.parent.parent.parent == SOURCE / "modules"


def module_name(file: Path) -> str:
    parts = file.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
