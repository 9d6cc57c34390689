"""The agent's riddles, and other words for each activity."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

from ravestate.yaml_text import load_yaml


@dataclass(frozen=True, slots=True)
class Riddle:
    """An activity that the user must guess."""

    name: str
    text: str
    hint: str
    words: tuple[str, ...]
    """Phrases that mean this activity."""


def _read() -> dict[str, Riddle]:
    file = files(__name__.rpartition(".")[0]) / "activities.yaml"
    found = load_yaml(file.read_text(encoding="utf-8"), str(file))
    return {name: Riddle(name, one["riddle"], one["hint"], tuple(one["words"])) for name, one in found.items()}


RIDDLES = _read()
"""Name of an activity → its riddle."""
