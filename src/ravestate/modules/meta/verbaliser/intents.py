"""An intent is a meaning that the agent wants to express. It does not contain the words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Intent:
    """A meaning that the agent wants to express. A `PhraseBook` has phrases for it.

    Example:
        >>> Intent("greet", {"name": "Ada"})
        Intent(name='greet', parameters={'name': 'Ada'}, package=None, file=None, phrases=None)
    """

    name: str
    """The intent's name in the files of phrases."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Name of a parameter in the phrases → its value. A value of None counts as missing."""
    package: str | None = None
    """The package whose ``phrases.yaml`` has phrases for the intent, usually the rule's ``__package__``."""
    file: Path | None = None
    """A file with phrases for the intent, for a rule outside packages."""
    phrases: Mapping[str, Sequence[str]] | None = None
    """Language → phrases, for a rule that provides the phrases itself. If given, no file is read."""
