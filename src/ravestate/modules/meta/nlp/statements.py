"""Read triples from a dependency tree, by the conventions of the README."""

from __future__ import annotations

from .clause import Clause
from .tree import Tree
from .triple import Triple

MOST = 64
"""The maximum number of triples from one text, because enumerations multiply."""


def triples_of(tree: Tree) -> tuple[Triple, ...]:
    """Return the statements and questions of the text: at most `MOST` triples, each once."""
    clauses = Clause.all_in(tree)
    found: dict[Triple, None] = {}
    for clause in clauses:
        for triple in clause.triples():
            found[triple] = None
            if len(found) == MOST:
                return tuple(found)
    return tuple(found)
