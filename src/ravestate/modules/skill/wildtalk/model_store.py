"""Ravestate's own folder of chat models: the catalogue, the installed files, and the default."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

from ravestate.errors import PlatformError, UsageError, nearest
from ravestate.folders import replace_file, user_folder
from ravestate.yaml_text import load_yaml

RECOMMENDED = "qwen2.5-1.5b"
"""The model that ``ravestate model get`` fetches if the user names none."""


@dataclass(frozen=True, slots=True)
class CatalogueModel:
    """A chat model that can be fetched: one file in a repository on the hub of Hugging Face."""

    name: str
    repository: str
    revision: str
    file: str
    size: int
    """Bytes."""
    sha256: str
    parameters: int
    licence: str
    purpose: str

    @property
    def path(self) -> Path:
        """The place of the installed file."""
        return folder() / self.file

    @property
    def part(self) -> Path:
        """The place of an unfinished download."""
        return folder() / f"{self.file}.part"

    @property
    def installed(self) -> bool:
        """Whether the whole file is installed. A file gets its name only after its checksum is verified.

        A file that was cut off later, for example by a full disk, does not count, so that it is fetched again.
        """
        return self.path.is_file() and self.path.stat().st_size == self.size


def folder() -> Path:
    """Return the folder of the installed models; it may not exist yet."""
    return user_folder("data") / "models"


@functools.cache
def catalogue() -> dict[str, CatalogueModel]:
    """Return the models that can be fetched, by name, smallest first."""
    file = Path(__file__).with_name("catalogue.yaml")
    models = [CatalogueModel(**entry) for entry in load_yaml(file.read_text(encoding="utf-8"), file.name)]
    return {model.name: model for model in models}


def named(name: str) -> CatalogueModel:
    """Return the catalogue's model with this name; raise `UsageError` if there is none."""
    if (model := catalogue().get(name.lower())) is None:
        known = ", ".join(catalogue())
        raise UsageError(f"there is no model {name!r}{nearest(name, catalogue())}; there are: {known}")
    return model


def default() -> CatalogueModel | None:
    """Return the default model, if it is installed."""
    try:
        name = (folder() / "default").read_text(encoding="utf-8").strip()
    except (OSError, ValueError, RuntimeError):  # no default was chosen, or the user has no home folder
        return None
    model = catalogue().get(name)
    return model if model is not None and model.installed else None


def set_default(name: str | None) -> None:
    """Make a model the default; None removes the default. Raise `PlatformError` if the folder cannot be written."""
    file = folder() / "default"
    try:
        if name is None:
            file.unlink(missing_ok=True)
        else:
            replace_file(file, f"{name}\n".encode())
    except OSError as error:
        why = f"{file} cannot be written: {error.strerror or error}"
        raise PlatformError(f"the default model stays as it was, because {why}") from error
