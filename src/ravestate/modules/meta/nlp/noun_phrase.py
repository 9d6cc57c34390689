"""Choose the words of a phrase that form a subject or object."""

from __future__ import annotations

from collections.abc import Container

from .phrase import Person, Phrase
from .tree import Tree, Word
from .word_set import word_set

DETERMINERS = word_set("the a an this that these those some any every each all both no another neither either")
"""Words that a phrase leaves out, unless it has no others."""

_KEPT = ("amod", "compound", "poss", "nummod", "nmod", "case", "det", "quantmod")


def noun_phrase(tree: Tree, head: Word) -> list[Word]:
    """Return the words of the noun phrase around `head`.

    It keeps possessives, adjectives, numbers, compounds and *of*. It drops determiners, adverbs, other prepositions and
    relative clauses.
    """
    if head.pos in ("VERB", "AUX") and head.dep not in ("ROOT", "conj"):
        return gerund_phrase(tree, head)
    kept = [head]
    for child in tree.children(head):
        determiner = child.low in DETERMINERS and (child.low, head.low) not in (
            ("no", "one"),
            ("each", "other"),
        )
        after = child.dep == "amod" and child.index > head.index  # are cats nice
        if child.dep in _KEPT and child.pos != "ADV" and not determiner and not after:
            kept += _joined_adjectives(tree, child) if child.dep == "amod" else noun_phrase(tree, child)
        elif child.dep == "prep" and child.low == "of" and child.index > head.index:
            for object in tree.children(child, "pobj", "pcomp"):
                kept += [child, *_with_conjuncts(tree, object)]
        elif child.dep == "appos" and _is_name(child, head) and not _comma_between(tree, head, child):
            kept += noun_phrase(tree, child)
    return _with_hyphens(tree, kept)


def adjective_phrase(tree: Tree, head: Word, verb: Word) -> list[Word]:
    """Return the words of a predicate adjective with its measure (*20 years old*) and the prepositional phrase after it.

    The parser attaches that phrase to the adjective or to the verb.
    """
    kept = [head]
    for child in tree.children(head, "npadvmod", "compound"):
        if child.index < head.index:
            kept += noun_phrase(tree, child)
    after = tree.after(head)
    if after is not None and after.dep in ("prep", "agent") and after.head in (head.index, verb.index):
        for object in tree.children(after, "pobj", "pcomp"):
            kept += [after, *_with_conjuncts(tree, object)]
    return _with_hyphens(tree, kept)


def gerund_phrase(tree: Tree, head: Word) -> list[Word]:
    """Return the words of a gerund phrase (*playing chess*) without determiners."""
    return without_determiners(tree.subtree(head))


def conjuncts(tree: Tree, head: Word, clauses: Container[int]) -> list[Word]:
    """Return `head` with its conjuncts, without the verbs in `clauses` (indices)."""
    found = [head]
    for word in found:  # the list grows in the loop
        found += [child for child in tree.children(word, "conj") if child.index not in clauses]
    return found


def without_determiners(words: list[Word]) -> list[Word]:
    """Return `words` without determiners and punctuation."""
    return [
        word
        for word in words
        if word.pos != "PUNCT" and not (word.dep in ("det", "predet") and word.low in DETERMINERS)
    ]


def _joined_adjectives(tree: Tree, adjective: Word) -> list[Word]:
    """Return joined adjectives with their conjunctions: *old and wise*."""
    kept = [adjective]
    for child in tree.children(adjective):
        if child.dep in ("cc", "npadvmod", "compound"):
            kept.append(child)
        elif child.dep == "conj":
            kept += _joined_adjectives(tree, child)
    return kept


def _with_conjuncts(tree: Tree, head: Word) -> list[Word]:
    kept = noun_phrase(tree, head)
    for child in tree.children(head):
        if child.dep == "cc":
            kept.append(child)
        elif child.dep == "conj":
            kept += _with_conjuncts(tree, child)
    return kept


def _is_name(word: Word, head: Word) -> bool:
    """Return whether an apposition is a name, perhaps in lower case: *my friend tom*."""
    return word.pos == "PROPN" or (word.pos == "NOUN" and word.tag == "NN" and word.index == head.index + 1)


def _comma_between(tree: Tree, first: Word, second: Word) -> bool:
    return any(word.pos == "PUNCT" for word in tree.words[first.index : second.index])


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


_SPEAKER = word_set("i me my mine myself we us our ours ourselves")
_AGENT = word_set("you your yours yourself u ur")
_NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]


def phrase_of(tree: Tree, head: Word, words: list[Word]) -> Phrase:
    """Return the phrase of `words` around `head`."""
    names = _names_in(tree, head)
    noun = _noun_of(tree, head)
    owner = next((word for word in tree.children(noun or head, "poss")), None) or next(
        (
            of
            for child in tree.children(noun or head, "prep")
            if child.low == "of"
            for of in tree.children(child, "pobj")
        ),
        None,
    )
    before = tree.head(head)
    return Phrase(
        tree.phrase(words),
        head="" if noun is None else noun.lemma.lower(),
        names=tuple(names),
        owner=None
        if owner is None
        else phrase_of(tree, owner, [word for word in noun_phrase(tree, owner) if word.dep != "case"]),
        amount=_amount(tree, head),
        person=person_of(head),
        preposition=before.low if head.dep in ("pobj", "pcomp") else "",
    )


def person_of(word: Word) -> Person:
    """Return the person of a pronoun; *other* for other words."""
    return "I" if word.low in _SPEAKER else "you" if word.low in _AGENT else "other"


def _noun_of(tree: Tree, head: Word) -> Word | None:
    """Return the common noun or adjective of a phrase: *friend* of *my friend Anna*."""
    if head.pos == "PROPN":
        return next((word for word in tree.children(head, "compound", "nmod") if word.pos == "NOUN"), None)
    return None if head.pos in ("PRON", "DET") else head


def _names_in(tree: Tree, head: Word) -> list[str]:
    """Return the names in a phrase: its head, appositions, and *named Rosa*."""
    found: list[str] = []
    if head.pos == "PROPN":
        kept = [head, *(word for word in tree.children(head, "compound", "flat") if word.pos == "PROPN")]
        found.append(tree.phrase(kept))
        found += [name for word in tree.children(head, "conj") for name in _names_in(tree, word) if head.dep == "appos"]
        return found
    if head.pos == "NOUN":
        for child in tree.children(head, "appos"):
            found += _names_in(tree, child)
        for child in tree.children(head, "acl", "relcl"):
            if child.low in ("named", "called"):
                found += [
                    name for word in tree.children(child, "oprd", "dobj", "attr") for name in _names_in(tree, word)
                ]
    return found


def _amount(tree: Tree, head: Word) -> float | None:
    """Return the number before the head: *two sisters*, *34 years old*."""
    for word in (
        *tree.children(head),
        *(deep for child in tree.children(head, "npadvmod") for deep in tree.children(child)),
    ):
        if word.dep in ("nummod", "det", "compound") and word.low in _NUMBERS:
            return float(_NUMBERS.index(word.low))
        if word.dep == "nummod":
            try:
                return float(word.low.replace(",", ""))
            except ValueError:
                continue
    return None
