"""Find a module by the name that a user types."""

from __future__ import annotations

import contextlib
import importlib.util
import sys
from collections.abc import Generator
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from ravestate.declare.module import Module, as_module
from ravestate.errors import DeclarationError, RavestateError, UsageError, nearest
from ravestate.modules import BUILT_IN

LIBRARIES = sys.stdlib_module_names | {"ravestate", "pydantic", "yaml"}
"""Python modules that every agent may import. A user's file with one of these names would replace the module."""


def load_module(name: str, folder: Path = Path()) -> Module:
    """Return a module by its built-in name, entry point, dotted path or file; a file is relative to `folder`.

    Examples of names are ``rawio``, the entry point of an installed package, ``pkg.mod``, ``pkg.mod:module`` and
    ``./hello.py``. If there is no such module, or importing it fails, raise a `UsageError`. But if the import itself
    raises a `RavestateError`, for instance about a wrong declaration, pass this error on.
    """
    if name.endswith(".py"):
        return _from_file(name, (folder / name).resolve())
    if name in BUILT_IN:
        return as_module(import_module(f"ravestate.modules.{BUILT_IN[name]}.{name}"))
    installed = {point.name: point for point in entry_points(group="ravestate.modules")}
    if name in installed:
        with _loading(f"entry point {name!r} ({installed[name].value}) fails"):
            return _as_module(name, installed[name].load())
    if "/" in name or name.startswith(".") or not name:
        raise UsageError(f"{name!r} is not a module: name a file (./hello.py), or a dotted path (pkg.mod)")
    if str(Path.cwd()) not in sys.path:  # by default, an installed command does not import from the working folder
        sys.path.insert(0, str(Path.cwd()))
    if "." in name or ":" in name or (name.isidentifier() and importlib.util.find_spec(name) is not None):
        return _from_path(name, [*BUILT_IN, *installed])
    raise UsageError(
        f"there is no module {name!r}{nearest(name, [*BUILT_IN, *installed])} (built in: {', '.join(BUILT_IN)})"
    )


def _from_path(name: str, known: list[str]) -> Module:
    path, _, attribute = name.partition(":")
    with _loading(f"module {name!r} fails when it is imported"):
        try:
            value: Any = import_module(path)
        except ModuleNotFoundError as error:
            raise UsageError(f"module {name!r}: {error}{nearest(name, known)}") from None
    if attribute:
        if not hasattr(value, attribute):
            alike = nearest(attribute, [*dir(value), *getattr(value, "__all__", ())])
            raise UsageError(f"{path} has no {attribute!r}{alike}")
        value = getattr(value, attribute)
    return _as_module(name, value)


def _from_file(name: str, path: Path) -> Module:
    if not path.is_file():
        raise UsageError(f"there is no file {name}")
    if path.stem in LIBRARIES:
        raise UsageError(f"{name} would replace the Python module {path.stem!r}: rename the file, e.g. my_{path.name}")
    known = sys.modules.get(path.stem)
    if known is not None and getattr(known, "__file__", None) == str(path):
        return _as_module(name, known)  # a test that has imported the file needs the same slot objects
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise UsageError(f"{name} is not a Python file")
    if str(path.parent) not in sys.path:  # the file may import other files in its folder
        sys.path.insert(0, str(path.parent))
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    try:
        with _loading(f"{name} fails when it is loaded"):
            spec.loader.exec_module(module)
    except BaseException:
        sys.modules.pop(path.stem, None)
        raise
    return _as_module(name, module)


@contextlib.contextmanager
def _loading(failure: str) -> Generator[None]:
    """If loading a user's module raises an exception, raise a `UsageError` whose message begins with `failure`.

    A `RavestateError` already has a good message, so it passes unchanged, and so does KeyboardInterrupt. ``sys.exit``
    counts as an exception, because it would end the command without a message.
    """
    try:
        yield
    except (RavestateError, KeyboardInterrupt):
        raise
    except SystemExit as error:
        raise UsageError(
            f"{failure}: {_where(error)} (it ends the process: code that must not run on import belongs under "
            "if __name__ == '__main__':)"
        ) from error
    except BaseException as error:
        raise UsageError(f"{failure}: {_where(error)}") from error


def _as_module(name: str, value: object) -> Module:
    try:
        return as_module(value)
    except DeclarationError as error:
        raise UsageError(f"{name}: {error}") from None


def _where(error: BaseException) -> str:
    """Return an exception as text in one line, with its place in the user's file."""
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    trace = error.__traceback__
    place = ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if not file.startswith("<") and "importlib" not in file and "ravestate" not in Path(file).parts:
            place = f"{file}:{trace.tb_lineno}: "
        trace = trace.tb_next
    return f"{place}{type(error).__name__}: {error}"
