"""Answers about the world from documents, always with their source."""

from __future__ import annotations

from . import rules as rules
from .answering import Answer, Answerer, Candidate
from .names import Settings, before, found, module
from .referring import Before

__all__ = ["Answer", "Answerer", "Before", "Candidate", "Settings", "before", "found", "module"]
