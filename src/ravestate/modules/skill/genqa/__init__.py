"""Answers about the world from documents, with the source of each answer."""

from __future__ import annotations

from . import rules as rules
from .answering import Answer, Answerer, Candidate
from .names import Settings, found, module, thread
from .thread import Turn

__all__ = ["Answer", "Answerer", "Candidate", "Settings", "Turn", "found", "module", "thread"]
