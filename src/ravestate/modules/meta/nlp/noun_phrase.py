"""Choose the words of a phrase that form a subject or object."""

from __future__ import annotations

from collections.abc import Container

from .tree import Tree, Word
from .word_set import word_set

DETERMINERS = word_set("the a an this that these those some any every each all both no another neither either")
"""Words that a phrase leaves out, unless it has no others."""
_KEPT = ("amod", "compound", "poss", "nummod", "nmod", "case", "det", "quantmod")
_PRONOUNS = (("no", "one"), ("each", "other"))


def noun_phrase(tree: Tree, head: Word) -> list[Word]:
    """Return the words of the noun phrase around `head`.

    It keeps possessives, adjectives, numbers, compounds and *of*. It drops determiners, adverbs, other prepositions and
    relative clauses.
    """
    if head.pos in ("VERB", "AUX") and head.dep not in ("ROOT", "conj"):
        return gerund_phrase(tree, head)
    kept = [head]
    for child in tree.children(head):
        dropped = child.pos == "ADV" or (child.low in DETERMINERS and (child.low, head.low) not in _PRONOUNS)
        if child.dep == "amod" and not dropped and child.index < head.index:  # after it: are cats nice
            kept += _joined(tree, child, [child])
        elif child.dep in _KEPT and child.dep != "amod" and not dropped:
            kept += noun_phrase(tree, child)
        elif child.dep == "prep" and child.low == "of" and child.index > head.index:
            kept += _after(tree, child)
        elif child.dep == "appos" and _is_name(tree, child, head):
            kept += noun_phrase(tree, child)
    return _with_hyphens(tree, kept)


def adjective_phrase(tree: Tree, head: Word, verb: Word) -> list[Word]:
    """Return the words of a predicate adjective with its measure (*20 years old*) and the prepositional phrase after it.

    The parser attaches that phrase to the adjective or to the verb.
    """
    kept = [head]
    for child in tree.children(head, "npadvmod", "compound"):
        kept += noun_phrase(tree, child) if child.index < head.index else []
    after = tree.after(head)
    if after is not None and after.dep in ("prep", "agent") and after.head in (head.index, verb.index):
        kept += _after(tree, after)
    return _with_hyphens(tree, kept)


def gerund_phrase(tree: Tree, head: Word) -> list[Word]:
    """Return the words of a gerund phrase (*playing chess*), without determiners and punctuation."""
    words = [word for word in tree.subtree(head) if word.pos != "PUNCT"]
    return [word for word in words if not (word.dep in ("det", "predet") and word.low in DETERMINERS)]


def conjuncts(tree: Tree, head: Word, clauses: Container[int]) -> list[Word]:
    """Return `head` with its conjuncts, without the verbs in `clauses` (indices)."""
    found = [head]
    for word in found:  # the list grows in the loop
        listed = [
            child for child in tree.children(word, "appos") if child.pos == word.pos
        ]  # two cats, a dog and a bird
        joined = [child for child in listed if tree.children(child, "conj")] + tree.children(word, "conj")
        found += [child for child in joined if child.index not in clauses]
    return found


def _after(tree: Tree, preposition: Word) -> list[Word]:
    """Return a preposition with its nouns; nothing without one."""
    nouns = tree.children(preposition, "pobj", "pcomp")
    words = [word for noun in nouns for word in _joined(tree, noun, noun_phrase(tree, noun))]
    return [preposition, *words] if nouns else []


def _joined(tree: Tree, head: Word, kept: list[Word]) -> list[Word]:
    """Return the words of a phrase with those of its conjuncts, and the conjunctions: *old and wise*."""
    for child in tree.children(head):
        if child.dep == "cc" or (head.dep == "amod" and child.dep in ("npadvmod", "compound")):
            kept = [*kept, child]
        elif child.dep == "conj":
            kept = [*kept, *_joined(tree, child, [child] if head.dep == "amod" else noun_phrase(tree, child))]
    return kept


def _is_name(tree: Tree, word: Word, head: Word) -> bool:
    """Return whether an apposition is a name without a comma, perhaps in lower case: *my friend tom*."""
    next_noun = word.pos == "NOUN" and word.tag == "NN" and word.index == head.index + 1
    comma = any(between.pos == "PUNCT" for between in tree.words[head.index : word.index])
    return (word.pos == "PROPN" or next_noun) and not comma


def _with_hyphens(tree: Tree, kept: list[Word]) -> list[Word]:
    """Add words joined by hyphens: the pipeline splits *well-known* into three."""
    indices = {word.index for word in kept}
    for index in sorted(indices):
        while index >= 2:
            hyphen, other = tree.words[index - 1], tree.words[index - 2]
            if hyphen.low not in "-–" or other.end != hyphen.start or hyphen.end != tree.words[index].start:
                break
            indices |= {index - 1, index - 2}
            index -= 2
    return [tree.words[index] for index in sorted(indices)]
