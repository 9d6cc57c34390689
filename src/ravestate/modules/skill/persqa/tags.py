"""The tagger that finds the values of facts in an utterance. ``tools/networks`` has its training."""

from __future__ import annotations

from pathlib import Path

from ravestate.language.tagger import Tagger

_NETWORK = Tagger(Path(__file__).with_name("facts.onnx"))


def tagger() -> Tagger:
    """Return the tagger of facts, which all contexts share. It may not be loaded yet."""
    return _NETWORK
