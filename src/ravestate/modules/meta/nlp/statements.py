"""Reads triples off a dependency tree. The conventions stand in the module's README; this is how they are met."""

from __future__ import annotations

from .clause import Clause
from .tree import Tree
from .triple import Triple

__all__ = ["MOST", "triples_of"]

MOST = 64
"""Triples of one text at most: enumerations multiply."""


def triples_of(tree: Tree) -> tuple[Triple, ...]:
    """Return what is stated and asked in the text, `MOST` triples at most, none twice."""
    clauses = Clause.all_in(tree)
    found: dict[Triple, None] = {}
    for clause in clauses:
        for triple in clause.triples():
            found[triple] = None
            if len(found) == MOST:
                return tuple(found)
    return tuple(found)
