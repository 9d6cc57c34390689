"""An agent named on the command line: modules, settings, and the file that may hold both."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import math
import os
import re
import sys
from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, cast

from ravestate.cli import UsageError
from ravestate.declare.module import Module, as_module
from ravestate.errors import DeclarationError, DeclarationErrors, RavestateError, nearest
from ravestate.modules import BUILT_IN
from ravestate.settings import load_settings, value_of, variable_of

__all__ = ["Agent", "add_arguments", "load_agent", "load_module"]

KEYS = ("modules", "settings", "seed", "patience")
NUMBERS: tuple[tuple[str, Callable[[Any], bool], str], ...] = (
    ("seed", lambda value: type(value) is int, "a whole number"),
    ("patience", lambda value: type(value) in (int, float) and 0 <= value < math.inf, "0 seconds or more"),
)
"""The keys of an agent file that are numbers, what such a number is, and how to say so."""
VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)(?::-([^}]*))?\}")


@dataclass(slots=True)
class Agent:
    """Modules, and what their contexts are to be given."""

    modules: list[Module]
    settings: dict[str, dict[str, Any]] = field(default_factory=dict[str, dict[str, Any]])
    seed: int | None = None
    patience: float = 1.0

    def options(self) -> dict[str, Any]:
        """The arguments for `ravestate.Context` besides the modules."""
        return {"settings": self.settings, "seed": self.seed, "patience": self.patience}


def add_arguments(parser: argparse.ArgumentParser, *, modules: str = "+") -> None:
    """The arguments that name an agent."""
    parser.add_argument(
        "modules",
        nargs=modules,
        metavar="MODULE",
        help="a built-in name (hibye), an installed entry point, a dotted path (pkg.mod or pkg.mod:module), a file "
        "(./hello.py), or an agent file (agent.yaml)",
    )
    parser.add_argument(
        "-f", "--file", metavar="FILE", help="an agent file: modules, settings, seed, patience"
    )
    parser.add_argument(
        "--set",
        dest="sets",
        action="append",
        default=[],
        metavar="MODULE.KEY=VALUE",
        help="a setting, before the file's and the environment's (may be repeated)",
    )
    parser.add_argument("--seed", type=int, help="of all random choices, to repeat a run")


def load_agent(options: argparse.Namespace, first: Iterable[str] = ()) -> Agent:
    """The agent that parsed arguments name; `first` are modules that it has in any case.

    Raises:
        UsageError: Something that is named does not exist or cannot be read. Of an agent file and of ``--set`` all
            mistakes are told at once.
    """
    agent = Agent([])
    faults: list[str] = []
    names = [(name, Path()) for name in first]
    files = [name for name in options.modules if name.endswith((".yaml", ".yml"))]
    if options.file:
        files.append(options.file)
    for file in files:
        names += _read_file(agent, Path(file), faults)
    names += [(name, Path()) for name in options.modules if name not in files]
    if not names and not faults:
        raise UsageError("name a module, or an agent file that names some")
    for name, folder in names:
        try:
            module = load_module(name, folder)
        except UsageError as error:
            if not faults:
                raise
            faults.append(str(error))
            continue
        if module not in agent.modules:
            agent.modules.append(module)
    for text in options.sets:
        _set(agent, text, faults)
    if faults:
        raise UsageError("\n".join([*faults, *_faults_of_settings(agent)]))
    if options.seed is not None:
        agent.seed = options.seed
    return agent


def _faults_of_settings(agent: Agent) -> list[str]:
    """What is wrong with settings, for who has made other mistakes too; without these it is told when they are used."""
    try:
        load_settings(_all(agent.modules), agent.settings)
    except DeclarationErrors as faults:
        return [str(fault) for fault in faults.exceptions]
    return []


def load_module(name: str, folder: Path = Path()) -> Module:
    """A module by its built-in name, entry point, dotted path or file.

    Args:
        name: What to load.
        folder: Against which a file's path is resolved.

    Raises:
        UsageError: There is no such module, or it fails when it is imported.
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
        raise UsageError(f"{name!r} is no module: name a file (./hello.py), or a dotted path (pkg.mod)")
    if str(Path.cwd()) not in sys.path:  # a command does not look there by itself
        sys.path.insert(0, str(Path.cwd()))
    if "." in name or ":" in name or (name.isidentifier() and importlib.util.find_spec(name) is not None):
        path, _, attribute = name.partition(":")
        with _loading(f"module {name!r} fails when it is imported"):
            try:
                value: Any = import_module(path)
            except ModuleNotFoundError as error:
                raise UsageError(
                    f"module {name!r}: {error}{nearest(name, [*BUILT_IN, *installed])}"
                ) from None
        if attribute:
            if not hasattr(value, attribute):
                raise UsageError(
                    f"{path} has no {attribute!r}{nearest(attribute, [*dir(value), *getattr(value, '__all__', ())])}"
                )
            value = getattr(value, attribute)
        return _as_module(name, value)
    raise UsageError(
        f"there is no module {name!r}{nearest(name, [*BUILT_IN, *installed])} (built in: {', '.join(BUILT_IN)})"
    )


def _from_file(name: str, path: Path) -> Module:
    if not path.is_file():
        raise UsageError(f"there is no file {name}")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise UsageError(f"{name} is no Python file")
    if str(path.parent) not in sys.path:  # so that it can import what lies beside it
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
    """Whatever a user's module raises while it is loaded becomes a message that begins with `failure`; so does its
    ``sys.exit``, which would otherwise end the command without a word."""
    try:
        yield
    except (RavestateError, KeyboardInterrupt):
        raise
    except SystemExit as error:
        raise UsageError(
            f"{failure}: {_where(error)} (it ends the process: write what is not to happen on import under "
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
    """An exception in one line, with the place in the user's file."""
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


def _read_file(agent: Agent, path: Path, faults: list[str]) -> list[tuple[str, Path]]:
    """Add what an agent file says; returns the modules that it names, with the folder they are relative to.

    What is wrong in it is added to `faults`, and the rest is taken.

    Raises:
        UsageError: The file cannot be read at all.
    """
    import yaml

    try:
        content: Any = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise UsageError(f"{path} is not valid YAML: {error}") from None
    if not isinstance(content, dict):
        raise UsageError(f"{path} must hold `modules: [...]`, and may hold {', '.join(KEYS[1:])}")
    said = cast("dict[str, Any]", content)
    wrong: list[str] = [f"unknown key {key!r}{nearest(str(key), KEYS)}" for key in said if key not in KEYS]
    modules: Any = said.get("modules", [])
    if not isinstance(modules, list) or not all(isinstance(m, str) for m in cast("list[Any]", modules)):
        wrong.append(f"modules must be a list of names, not {modules!r}")
        modules = []
    settings = _filled(said.get("settings") or {}, wrong)
    if not isinstance(settings, Mapping):
        wrong.append(f"settings must map a module to its settings, not {settings!r}")
        settings = {}
    for module, values in cast("Mapping[str, Any]", settings).items():
        if not isinstance(values, Mapping):
            wrong.append(f"settings of {module} must be keys and values, not {values!r}")
            continue
        agent.settings.setdefault(str(module), {}).update(
            (key, value)
            for key, value in cast("Mapping[str, Any]", values).items()
            if variable_of(str(module), str(key)) not in os.environ  # which goes before a file
        )
    for key, is_one, kind in NUMBERS:
        if key in said:
            if is_one(said[key]):
                setattr(agent, key, said[key])
            else:
                wrong.append(f"{key} must be {kind}, not {said[key]!r}")
    faults += dict.fromkeys(f"{path}: {fault}" for fault in wrong)  # each once
    return [(name, path.parent) for name in cast("list[str]", modules)]


def _filled(value: Any, wrong: list[str]) -> Any:
    """Replace ``${NAME}`` and ``${NAME:-default}`` by the environment's values: secrets do not belong into files."""
    if isinstance(value, str):

        def fill(match: re.Match[str]) -> str:
            default: str | None = match[2]  # None where none is written
            found = os.environ.get(match[1], default)
            if found is None:
                wrong.append(f"the environment has no {match[1]}; set it, or write ${{{match[1]}:-default}}")
            return found or ""

        return VARIABLE.sub(fill, value)
    if isinstance(value, dict):
        return {key: _filled(item, wrong) for key, item in cast("dict[Any, Any]", value).items()}
    if isinstance(value, list):
        return [_filled(item, wrong) for item in cast("list[Any]", value)]
    return value


def _set(agent: Agent, text: str, faults: list[str]) -> None:
    """Take a ``--set``; what is wrong with it is added to `faults`, but for its value, which the settings judge."""
    name, equals, said = text.partition("=")
    module, dot, key = name.strip().partition(".")
    if not equals or not dot or not module or not key:
        faults.append(f"--set {text}: write --set module.key=value, e.g. --set idle.bored_after=10")
        return
    known = {found.name: found for found in _all(agent.modules)}
    if module not in known:
        is_one = module in BUILT_IN
        hint = ": name it too" if is_one else nearest(module, known) or nearest(module, BUILT_IN)
        faults.append(f"--set {text}: module {module!r} is not part of this agent{hint}")
    elif (settings := known[module].settings) is None:
        faults.append(f"--set {text}: module {module!r} has no settings")
    elif key not in settings.model_fields:
        faults.append(
            f"--set {text}: module {module!r} has no such setting{nearest(key, settings.model_fields)} "
            f"(it has: {', '.join(settings.model_fields)})"
        )
    else:
        agent.settings.setdefault(module, {})[key] = value_of(said, settings, key, _parse)


def _parse(text: str) -> Any:
    """A value as in a file: numbers, ``true``, ``[a, b]``."""
    import yaml

    try:
        return "" if not text else yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError from error


def _all(modules: Iterable[Module]) -> list[Module]:
    """The modules and all that they require."""
    found = list(modules)
    for module in found:  # grows on the way
        found += [required for required in module.requires if required not in found]
    return found
