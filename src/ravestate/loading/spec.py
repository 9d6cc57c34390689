"""An agent as its files describe it: modules, settings, seed and patience."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from reprlib import repr as short
from typing import Any, cast

from ravestate.declare.module import Module
from ravestate.errors import DeclarationError, DeclarationErrors, UsageError, nearest
from ravestate.loading.modules import load_module
from ravestate.modules import BUILT_IN
from ravestate.settings import field_of, from_folder, load_settings, value_of, variable_of
from ravestate.yaml_text import load_yaml

KEYS = ("modules", "settings", "seed", "patience")
NUMBERS: tuple[tuple[str, Callable[[Any], bool], str], ...] = (
    ("seed", lambda value: type(value) is int, "a whole number"),
    (
        "patience",
        lambda value: type(value) in (int, float) and 0 <= value < math.inf,
        "a finite number of seconds, 0 or more",
    ),
)
"""The numbers in an agent file: each key, its test, and a description of a valid value."""
VARIABLE = re.compile(r"\$\{([A-Za-z_][A-Za-z0-9_]*)(?::-([^}]*))?\}")
"""A variable of the environment in a setting: ``${NAME}`` or ``${NAME:-default}``."""


@dataclass(slots=True)
class AgentSpec:
    """The modules of an agent, and the options of its contexts. Fill it from files and options, then call `check`.

    Attributes:
        modules: The modules, in order.
        settings: Name of a module → key → value. Only settings from files and options are here.
        seed: The seed of random choices; `None` for a new seed in each run.
        patience: The patience (seconds) of rules that declare no patience: see `Module.rule` (law L16).
        faults: A message for each mistake so far.
    """

    modules: list[Module] = field(default_factory=list[Module])
    settings: dict[str, dict[str, Any]] = field(default_factory=dict[str, dict[str, Any]])
    seed: int | None = None
    patience: float = 1.0
    faults: list[str] = field(default_factory=list[str])
    _read: list[tuple[str, str, Any, Path]] = field(default_factory=list[tuple[str, str, Any, Path]])
    """The settings from files, in order: module, key, value, and the file. `load` moves them to `settings`."""

    @classmethod
    def from_file(cls, path: Path) -> AgentSpec:
        """Read an agent file and load its modules, or raise a `UsageError` that lists all mistakes.

        If only values of settings are wrong, raise nothing: see `check`.
        """
        spec = cls()
        spec.load(spec.read(path))
        spec.check()
        return spec

    def options(self) -> dict[str, Any]:
        """Return the arguments for `ravestate.Context`, without the modules."""
        return {"settings": self.settings, "seed": self.seed, "patience": self.patience}

    def read(self, path: Path) -> list[tuple[str, Path]]:
        """Read the settings, the seed and the patience of an agent file, and add its mistakes to `faults`.

        Return the names of the file's modules, each with the folder of the file, for `load`. If the file cannot be read
        at all, raise a `UsageError`.
        """
        try:
            content: Any = load_yaml(path.read_text(encoding="utf-8"), str(path))
        except OSError as error:
            raise UsageError(f"cannot read {path}: {error.strerror}") from None
        except UnicodeDecodeError as error:
            raise UsageError(f"{path}: not valid YAML ({error})") from None
        except DeclarationError as error:
            raise UsageError(str(error)) from None
        if not isinstance(content, dict):
            raise UsageError(f"{path} must hold `modules: [...]`, and may hold {', '.join(KEYS[1:])}")
        said = cast("dict[str, Any]", content)
        wrong = [f"unknown key {key!r}{nearest(str(key), KEYS)}" for key in said if key not in KEYS]
        modules: Any = said.get("modules", [])
        if not isinstance(modules, list) or not all(isinstance(m, str) for m in cast("list[Any]", modules)):
            wrong.append(f"modules must be a list of names, not {short(said['modules'])}")
            modules = []
        self._read_settings(_filled(said.get("settings") or {}, wrong), path, wrong)
        for key, fits, kind in NUMBERS:
            if key in said:
                if fits(said[key]):
                    setattr(self, key, said[key])
                else:
                    wrong.append(f"{key} must be {kind}, not {short(said[key])}")
        self.faults += dict.fromkeys(f"{path}: {fault}" for fault in wrong)  # each fault once
        return [(name, path.parent) for name in cast("list[str]", modules)]

    def load(self, names: Iterable[tuple[str, Path]]) -> None:
        """Load modules. Then move each setting from a file to `settings`, unless an environment variable overrides it.

        The loaded modules say which settings are paths. A relative path is relative to the folder of the file that
        gives it.

        Args:
            names: The names of modules. If a name is a relative path, it is relative to the folder given with it.

        Raises:
            UsageError: A module cannot be loaded. If there are `faults` already, the message is added to them instead.
        """
        for name, folder in names:
            try:
                module = load_module(name, folder)
            except UsageError as error:
                if not self.faults:
                    raise
                self.faults.append(str(error))
                continue
            if module not in self.modules:
                self.modules.append(module)
        models = {module.name: module.settings for module in with_required(self.modules)}
        first: dict[tuple[Path, str, str], str] = {}  # file, module, field → the name that the file uses first
        for name, said, value, file in self._read:
            key = said
            if (model := models.get(name)) is not None:
                key = field_of(model, said)
                value = from_folder(value, model, key, file.parent)
            if (before := first.setdefault((file, name, key), said)) != said:
                self.faults.append(
                    f"{file}: setting {name}.{key} is given twice, as {before!r} and as {said!r}: write it once"
                )
            if variable_of(name, key) not in os.environ:  # the environment overrides a file
                self.settings[name][key] = value
        self._read.clear()

    def set(self, text: str) -> None:
        """Take a setting from the text ``module.key=value``, but do not check its value. Add mistakes to `faults`."""
        name, equals, said = text.partition("=")
        module, dot, key = name.strip().partition(".")
        if not equals or not dot or not module or not key:
            self.faults.append(f"--set {text}: write --set module.key=value, e.g. --set idle.bored_after=10")
            return
        known = {found.name: found for found in with_required(self.modules)}
        if module not in known:
            hint = ": add the module" if module in BUILT_IN else nearest(module, known) or nearest(module, BUILT_IN)
            self.faults.append(f"--set {text}: module {module!r} is not part of this agent{hint}")
        elif (settings := known[module].settings) is None:
            self.faults.append(f"--set {text}: module {module!r} has no settings")
        elif (key := field_of(settings, key)) not in settings.model_fields:
            self.faults.append(
                f"--set {text}: module {module!r} has no such setting{nearest(key, settings.model_fields)} "
                f"(it has: {', '.join(settings.model_fields)})"
            )
        else:
            value = value_of(said, settings, key, lambda text: load_yaml(text, "--set") if text else "")
            self.settings.setdefault(module, {})[key] = value

    def check(self) -> None:
        """If there are `faults`, raise a `UsageError` with all of them, and with the faults of the settings.

        Without `faults`, do not check the settings, because compiling the modules checks them anyway.
        """
        if not self.faults:
            return
        try:
            load_settings(with_required(self.modules), self.settings)
        except DeclarationErrors as faults:
            self.faults += map(str, faults.exceptions)
        raise UsageError("\n".join(self.faults))

    def _read_settings(self, settings: Any, file: Path, wrong: list[str]) -> None:
        if not isinstance(settings, Mapping):
            wrong.append(f"settings must map a module to its settings, not {short(settings)}")
            return
        for module, values in cast("Mapping[str, Any]", settings).items():
            if not isinstance(values, Mapping):
                wrong.append(f"settings of {module} must be keys and values, not {short(values)}")
                continue
            self.settings.setdefault(str(module), {})
            self._read += [
                (str(module), str(key), value, file) for key, value in cast("Mapping[Any, Any]", values).items()
            ]


def _filled(value: Any, wrong: list[str]) -> Any:
    """Return the value with ``${NAME}`` and ``${NAME:-default}`` replaced by the environment's values."""
    if isinstance(value, str):

        def fill(match: re.Match[str]) -> str:
            default: str | None = match[2]  # None if the file gives no default
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


def with_required(modules: Iterable[Module]) -> list[Module]:
    """Return the modules and all modules that they require."""
    found = list(modules)
    for module in found:  # the list grows during the loop
        found += [required for required in module.requires if required not in found]
    return found
