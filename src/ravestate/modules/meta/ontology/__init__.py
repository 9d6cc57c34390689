"""Long-term memory: a property graph of the agent's knowledge, which outlives the process."""

from __future__ import annotations

from . import rules
from .bound import bound
from .graph import Graph
from .memory import Memory
from .names import Settings, memory, module
from .node import Node, Relation, Value
from .reply import Reply
from .types import Types

__all__ = [
    "Graph",
    "Memory",
    "Node",
    "Relation",
    "Reply",
    "Settings",
    "Types",
    "Value",
    "bound",
    "memory",
    "module",
    "rules",
]
