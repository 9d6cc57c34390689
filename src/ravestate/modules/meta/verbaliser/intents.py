"""What is meant, before it is worded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["Intent"]


@dataclass(frozen=True, slots=True)
class Intent:
    """What an agent means to say.

    Example:
        >>> Intent("greet", {"name": "Ada"})
        Intent(name='greet', parameters={'name': 'Ada'}, package=None)
    """

    name: str
    """The intent's name in the files of phrases."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Values for the braces in phrases; None counts as not given."""
    package: str | None = None
    """The package whose file ``phrases.yaml`` has the phrases, mostly ``__package__`` of the rule that means it.
    None: the verbaliser's own, or the user's."""
