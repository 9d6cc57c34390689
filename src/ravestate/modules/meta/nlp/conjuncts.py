"""Joined phrases, and *not* before one of them."""

from __future__ import annotations

from collections.abc import Container

from .tree import Tree, Word


def conjuncts(tree: Tree, head: Word, clauses: Container[int]) -> list[Word]:
    """Return `head` with its conjuncts, without the verbs in `clauses` (indices)."""
    found = [head]
    for word in found:  # the list grows in the loop
        found += [child for child in tree.children(word, "conj") if child.index not in clauses]
    return found


def is_contrasted(tree: Tree, word: Word, clauses: Container[int]) -> bool:
    """Return whether *not* precedes this conjunct alone: *coffee* in *tea, but not coffee*."""
    return word.dep == "conj" and any(denies_conjunct(tree, child, clauses) for child in _negations_at(tree, word))


def _negations_at(tree: Tree, word: Word) -> list[Word]:
    first = tree.subtree(word)[0]
    before = tree.before(first)
    return [w for w in (first, before) if w is not None and w.low == "not"]


def denies_conjunct(tree: Tree, negation: Word, clauses: Container[int]) -> bool:
    """Return whether a *not* denies one conjunct alone, and not the verb."""
    after = tree.after(negation)
    if after is None:
        return False
    for word in (after, *tree.ancestors(after)):
        if word.dep == "conj" and word.index not in clauses:
            return tree.subtree(word)[0].index in (after.index, negation.index)
    return False
