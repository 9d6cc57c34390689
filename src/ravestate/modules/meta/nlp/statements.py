"""Read triples from a dependency tree, by the conventions of the README."""

from __future__ import annotations

from dataclasses import dataclass

from .clause import Clause
from .tree import Tree
from .triple import Triple

MOST = 64
"""The maximum number of triples from one text, because enumerations multiply."""


@dataclass(frozen=True, slots=True)
class Statement:
    """A triple with the circumstances under which it holds, read from the parse."""

    triple: Triple
    negated: bool = False
    past: bool = False
    hearsay: bool = False
    """Somebody is said to have said so."""
    conditional: bool = False
    """It holds only if something else does, or is only imagined or wished."""
    question: bool = False
    subject_person: int = 3
    """The grammatical person of the subject: 1 the user, 2 the agent, 3 anybody or anything else."""


def statements_of(tree: Tree) -> tuple[Statement, ...]:
    """Return the triples of the text, with their circumstances."""
    return tuple(Statement(triple, negated=triple.predicate.startswith("not ")) for triple in triples_of(tree))


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
