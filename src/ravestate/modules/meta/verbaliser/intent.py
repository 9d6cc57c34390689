"""What is meant, before it is worded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

__all__ = ["Intent"]


@dataclass(frozen=True, slots=True)
class Intent:
    """What is to be said: its name in the files of phrases, and values for their parameters.

    Attributes:
        name: The intent's name, e.g. ``"greeting"``.
        parameters: Values for ``{parameters}`` in its phrases; None counts as not given.
        phrases: The file of the module that has it; users may replace its phrases by files of their own.
    """

    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict[str, Any])
    phrases: Path | None = None
