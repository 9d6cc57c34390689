"""The tagger that finds the values of facts in an utterance. ``tools/networks`` has its training."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ravestate.language.tagger import Tagger


@cache
def tagger() -> Tagger:
    """Return the tagger of facts, which all contexts share. It may not be loaded yet."""
    return Tagger(Path(__file__).with_name("facts.onnx"))
