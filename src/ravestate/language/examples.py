"""Read the example sentences of classes from YAML files. Designers can write such files, too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, cast

from ravestate.errors import DeclarationError, PlatformError
from ravestate.yaml_text import load_yaml

NONE = "none"
"""The key of sentences that belong to no class."""


@dataclass(frozen=True, slots=True)
class Examples:
    """Example sentences of several classes, and sentences that belong to no class."""

    classes: Mapping[str, tuple[str, ...]]
    none: tuple[str, ...] = ()


def read_examples(file: Path | Traversable) -> Examples:
    """Read a mapping from classes to sentences. The key ``none`` holds sentences that belong to no class.

    Raises:
        DeclarationError: The file is not such a mapping.
        PlatformError: The file cannot be read.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise PlatformError(f"the examples {str(file)!r} cannot be read: {error}") from error
    return parse_examples(load_yaml(text, str(file)), str(file))


def parse_examples(found: Any, source: str) -> Examples:
    """Return the examples of a YAML value.

    Raises:
        DeclarationError: The value is not a mapping from names to lists of texts.
    """
    if not isinstance(found, Mapping):
        raise DeclarationError(f"{source}: write a mapping from a class to its sentences: greeting: [hello, hi there]")
    classes: dict[str, tuple[str, ...]] = {}
    for name, texts in cast("Mapping[Any, Any]", found).items():
        listed = cast("Sequence[Any]", texts) if isinstance(texts, list) else None
        if not listed or not all(isinstance(text, str) and text.strip() for text in listed):
            raise DeclarationError(f"{source}: {name!r} needs a list of sentences; put yes, no and numbers in quotes")
        classes[str(name)] = tuple(listed)
    return Examples(classes, classes.pop(NONE, ()))


@cache
def bundled(name: str) -> Examples:
    """Return the built-in examples with this name: ``acts``, ``feelings``, ``none``..."""
    return read_examples(files("ravestate.language") / "examples" / f"{name}.yaml")
