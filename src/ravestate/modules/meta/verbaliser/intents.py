"""What is meant, before it is worded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

__all__ = ["Intent"]


@dataclass(frozen=True, slots=True)
class Intent:
    """What an agent means to say.

    Example:
        >>> Intent("greet", {"name": "Ada"})
        Intent(name='greet', parameters={'name': 'Ada'}, package=None, file=None, phrases=None)
    """

    name: str
    """The intent's name in the files of phrases."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Values for the braces in phrases; None counts as not given."""
    package: str | None = None
    """The package whose file ``phrases.yaml`` has the phrases, mostly ``__package__`` of the rule that means it."""
    file: Path | None = None
    """A file that has the phrases, for a rule that stands in no package."""
    phrases: Mapping[str, Sequence[str]] | None = None
    """Its phrases by language, for a rule that has them from elsewhere; files are then not asked."""
