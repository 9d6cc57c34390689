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
from pathlib import Path
from typing import NamedTuple

import pytest

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
    """An import: its absolute module, the names taken from it, and whether it runs only when its function is called."""

    line: int
    module: str
    names: tuple[str, ...]
    late: bool


@functools.cache
def imports_in(file: Path) -> list[Import]:
    """Return the imports of a file, without imports for type checkers."""
    package = ("ravestate", *file.relative_to(SOURCE).parent.parts)

    def visit(node: ast.AST, late: bool) -> Iterator[Import]:
        children: Iterable[ast.AST] = ast.iter_child_nodes(node)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            children = node.orelse
        elif isinstance(node, ast.Import):
            yield from (Import(node.lineno, alias.name, (), late) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            origin = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*origin, *([node.module] if node.module else [])))
            yield Import(node.lineno, module, tuple(alias.name for alias in node.names), late)
        late = late or isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
        for child in children:
            if isinstance(child, (ast.stmt, ast.ExceptHandler, ast.match_case)):  # an expression contains no import
                yield from visit(child, late)

    return list(visit(ast.parse(file.read_text(encoding="utf-8"), str(file)), False))


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
        for line, module, _, _ in imports_in(file)
        if not {module, module.partition(".")[0]} & {"ravestate", *PURE_LIBRARY}
    ]
    assert not impure, "\n".join(impure)


def test_nothing_imports_the_command_line() -> None:
    guilty = [
        f"{path_of(file)}:{line}: {module}"
        for file in files_of(".")
        if not (path_of(file).startswith("cli/") or path_of(file) == "__main__.py")
        for line, module, names, _ in imports_in(file)
        if f"{module}.".startswith("ravestate.cli.") or (module == "ravestate" and "cli" in names)
    ]
    assert not guilty, "\n".join(guilty)


def test_skills_do_not_import_platforms() -> None:
    platforms = {place.stem for place in (SOURCE / "modules" / "platform").glob("[!_]*")}
    guilty = [
        f"{path_of(file)}:{line}: {module} {', '.join(names)}"
        for file in files_of("modules/skill")
        for line, module, names, _ in imports_in(file)
        if (lazy := module == "ravestate.modules" and platforms.intersection({*names, "platform"}))
        or lazy
        or f"{module}.".startswith("ravestate.modules.platform.")
        or module.removeprefix("ravestate.modules.") in platforms
    ]
    assert not guilty, "\n".join(guilty)


def test_all_modules_are_folders_with_the_same_files() -> None:
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


def test_imports_form_no_cycle() -> None:
    """Imports at the top of files form no cycle. Imports within functions run later, so they do not count."""
    files = {module_name(file): file for file in SOURCE.rglob("*.py")}
    graph: dict[str, set[str]] = {}
    for name, file in files.items():
        graph[name] = {
            target
            for _, module, names, late in imports_in(file)
            if not late
            for target in [f"{module}.{each}" for each in names if f"{module}.{each}" in files] or [module]
            if target in files and target != name
        }
    TopologicalSorter(graph).prepare()  # raises a CycleError that names the files


def module_name(file: Path) -> str:
    parts = file.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
