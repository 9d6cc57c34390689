"""An intent: a meaning that the agent wants to express, without its words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Intent:
    """A meaning that the agent wants to express; a `PhraseBook` has the words.

    Example:
        >>> Intent("greet", {"name": "Ada"})
        Intent(name='greet', parameters={'name': 'Ada'}, package=None, file=None, phrases=None)
    """

    name: str
    """The intent's name in the files of phrases."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Name of a parameter in phrases → its value; None counts as missing."""
    package: str | None = None
    """The package whose ``phrases.yaml`` has phrases for the intent, usually the rule's ``__package__``."""
    file: Path | None = None
    """A file with phrases for the intent, for a rule outside packages."""
    phrases: Mapping[str, Sequence[str]] | None = None
    """Language → phrases, for a rule that provides the phrases itself. If given, no file is read."""
