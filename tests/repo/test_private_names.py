"""Tests use public names only.

A private name begins with one underscore. It belongs to the file that defines it, and nothing else may depend on it:
a test states what a user or a neighbouring file can see. A public name within a private file, such as
`ravestate.modules._text`, is public to all modules and so to the tests.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "ravestate"
TESTS = ROOT / "tests"

PRIVATE = re.compile(r"_[A-Za-z0-9]\w*")
DEFINED = re.compile(r"(?:\b(?:def|class) |\bself\.|^ *)(_[A-Za-z0-9]\w*)", re.MULTILINE)
DOTTED = re.compile(r"ravestate(\.\w+)+")
TAKE_NAMES = {"delattr", "getattr", "hasattr", "setattr"}

NAMED_TUPLE = {"_asdict", "_field_defaults", "_fields", "_make", "_replace"}
"""The names of `collections.namedtuple` that are public in spite of their underscores."""

ALLOWED = {
    ("modules/platform/ros/peer1.py", "_response_class"): "genpy gives this attribute to each class of a service",
}
"""The reason why a test file, relative to `tests`, may use a private name of another file."""


def private_names_of(file: Path) -> set[str]:
    """Return the private names that a file defines: its functions, classes, variables and attributes."""
    return set(DEFINED.findall(file.read_text(encoding="utf-8")))


def private_names_used_in(file: Path) -> Iterator[tuple[int, str]]:
    """Yield the line and the name of each private attribute, import and text with such a name in a file.

    Texts with names count where they are given to a function like `getattr`, and with a path: "ravestate.module.name".
    """
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"), str(file))):
        names: list[str] = []
        match node:
            case ast.Attribute(value=ast.Name(id="self" | "cls")):
                pass
            case ast.Attribute(attr=name):
                names = [name]
            case ast.ImportFrom(names=aliases):
                names = [alias.name for alias in aliases]
            case ast.Call(
                func=ast.Name(id=called) | ast.Attribute(attr=called), args=[_, ast.Constant(value=str(name)), *_]
            ):
                names = [name] if called in TAKE_NAMES else []
            case ast.Constant(value=str(text)) if DOTTED.fullmatch(text):
                names = [text.rpartition(".")[2]]
            case _:
                continue
        yield from ((node.lineno, name) for name in names if PRIVATE.fullmatch(name))


def test_no_test_uses_a_private_name_of_another_file() -> None:
    owners = {name for folder in (SOURCE, TESTS) for file in folder.rglob("*.py") for name in private_names_of(file)}
    guilty = [
        f"{path}:{line}: {name}"
        for file in sorted(TESTS.rglob("*.py"))
        for path in [file.relative_to(TESTS).as_posix()]
        for line, name in private_names_used_in(file)
        if name in owners and name not in private_names_of(file) | NAMED_TUPLE and (path, name) not in ALLOWED
    ]
    assert not guilty, "\n".join(guilty)


def test_every_exception_is_needed() -> None:
    unused = [
        f"{path}: {name}"
        for path, name in ALLOWED
        if name not in {used for _, used in private_names_used_in(TESTS / path)}
    ]
    assert not unused, "\n".join(unused)
