"""An intent: a meaning without words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Intent:
    """A meaning that the agent wants to say.

    Example:
        >>> Intent("greet", {"name": "Ada"})
        Intent(name='greet', parameters={'name': 'Ada'}, package=None, file=None, phrases=None)
    """

    name: str
    """The intent's name in the files of phrases."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Values for the parameters of phrases; None counts as missing."""
    package: str | None = None
    """The package that contains ``phrases.yaml``, usually the rule's ``__package__``."""
    file: Path | None = None
    """A file with the phrases, for a rule outside packages."""
    phrases: Mapping[str, Sequence[str]] | None = None
    """The phrases by language, for a rule that provides them itself; then no file is read."""
