"""Read triples and statements from a dependency tree, by the conventions of the README."""

from __future__ import annotations

from collections.abc import Sequence

from ravestate.language.entity import Entity

from .assertion import Assertion
from .clause import Clause
from .statement import Statement
from .tree import Tree
from .triple import Triple

MOST = 64
"""The maximum number of triples from one text, because enumerations multiply."""


def triples_of(tree: Tree) -> tuple[Triple, ...]:
    """Return the statements and questions of the text: at most `MOST` triples, each once."""
    return tuple(dict.fromkeys(statement.triple for statement in statements_of(tree)))


def statements_of(tree: Tree, entities: Sequence[Entity] = ()) -> tuple[Statement, ...]:
    """Return the triples of the text, at most `MOST`, each once, with what their clauses say about them.

    Example:
        The only statement of *my sister used to live in Rome* has the subject's head ``sister``, and it is past.
    """
    found: dict[Triple, Statement] = {}
    for clause in Clause.all_in(tree):
        assertion = Assertion(tree, clause, entities)
        for triple, subject, object in clause.readings():
            if triple not in found:
                found[triple] = assertion.statement(triple, subject, object)
            if len(found) == MOST:
                return tuple(found.values())
    return tuple(found.values())
