"""Phrases: the words of a subject or object, and the parts of them that skills use."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass
from typing import Literal

from ravestate.language.contractions import word_set

from .tree import Tree, Word

Person = Literal["I", "you", "other"]
"""The speaker (*I, my, we*), the agent (*you, your*), or any other person or thing."""


@dataclass(frozen=True, slots=True)
class Phrase:
    """A noun phrase with the parts that skills use.

    Example:
        *my two sisters* has the head ``sister``, the owner *my* (person ``I``), and the amount 2. *my sister Rosa* has
        the head ``sister`` and the name ``Rosa``; *Rosa* alone has no head.
    """

    text: str
    """The phrase as the triple has it, for example ``my sister Rosa``."""
    head: str = ""
    """The lemma of the common noun, for example ``sister``, or the adjective or gerund itself, in lower case.
    It is empty for names and pronouns."""
    names: tuple[str, ...] = ()
    """The names in the phrase, as written. For example, *two brothers, Max and Tim* has ``("Max", "Tim")``."""
    owner: Phrase | None = None
    """The possessor, for example *my mother* in *my mother's name*, or *Peru* in *the capital of Peru*."""
    amount: float | None = None
    """The number before the head, for example 2 in *two sisters*, 0 in *no sisters*, and 34 in *34 years old*."""
    person: Person = "other"
    """``I`` and ``you`` for pronouns; ``other`` for everything else, also for *my sister*."""
    preposition: str = ""
    """The preposition before the phrase, in lower case, for example ``in``."""

    @property
    def name(self) -> str:
        """The first of `names`; an empty string if there are none."""
        return self.names[0] if self.names else ""

    def of(self, person: Person) -> bool:
        """Return whether the phrase belongs to `person`: *my sister* and *my mother's name* belong to ``I``."""
        return self.owner is not None and (self.owner.person == person or self.owner.of(person))


DETERMINERS = word_set("the a an this that these those some any every each all both no another neither either")
"""Words that the text of a phrase leaves out, unless the phrase has no other words."""
_KEPT = ("amod", "compound", "poss", "nummod", "nmod", "case", "det", "quantmod", "pobj", "pcomp")
_PRONOUNS = (("no", "one"), ("each", "other"))
_SPEAKER = word_set("i me my mine myself we us our ours ourselves")
_AGENT = word_set("you your yours yourself u ur")
_NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]


def phrase_of(tree: Tree, head: Word, words: list[Word] | None = None) -> Phrase:
    """Return the phrase that `words` form around `head`. By default, `words` is the noun phrase of `head`."""
    noun = None if head.pos in ("PRON", "DET") else head
    if head.pos == "PROPN":  # as in "my friend Anna": the head is "friend"
        beside = tree.children(head, "compound", "nmod")
        noun = next((word for word in beside if word.pos == "NOUN" or _is_common(tree, word, head)), None)
    of = [word for word in tree.children(noun or head, "prep") if word.low == "of"]
    owned = [*tree.children(noun or head, "poss"), *tree.children_of(of, "pobj"), *tree.children(head, "poss")]
    owner = next(iter(owned), None)
    first = head
    while first.dep == "conj" and tree.head(first).dep in ("conj", "pobj"):  # as in "in Rome and Paris"
        first = tree.head(first)
    return Phrase(
        tree.phrase(noun_phrase(tree, head) if words is None else words),
        head="" if noun is None else f"{noun.lemma.lower() if noun.pos == 'NOUN' else noun.low}{_in_law(tree, noun)}",
        names=tuple(_names_in(tree, head)),
        owner=owner and phrase_of(tree, owner, [word for word in noun_phrase(tree, owner) if word.dep != "case"]),
        amount=_amount(tree, head),
        person=person_of(head),
        preposition=tree.head(first).low if first.dep in ("pobj", "pcomp") else "",
    )


def person_of(word: Word) -> Person:
    """Return the person of a pronoun; *other* for other words."""
    return "I" if word.low in _SPEAKER else "you" if word.low in _AGENT else "other"


def noun_phrase(tree: Tree, head: Word, *, joined: bool = False) -> list[Word]:
    """Return the words of the noun phrase around `head`; if `joined`, with its conjuncts.

    The phrase keeps possessives, adjectives, numbers, compounds and *of*. It drops determiners, adverbs, other
    prepositional phrases and relative clauses. A gerund (*playing chess*) keeps everything except determiners.
    """
    if head.pos in ("VERB", "AUX") and head.dep not in ("ROOT", "conj", "amod"):
        return gerund_phrase(tree, head)
    kept = [head]
    for child in tree.children(head):
        of = child.low == "of" and child.index > head.index and bool(tree.children(child))
        denied = any(word.low == "not" for word in tree.children(child, "neg"))  # as in "capital of Peru, not Chile"
        listed = joined and child.dep in ("cc", "conj") and not denied
        if of or _belongs(tree, child, head) or listed:
            kept += noun_phrase(tree, child, joined=of or child.dep == "amod" or (joined and child.dep != "poss"))
    return _with_hyphens(tree, kept)


def adjective_phrase(tree: Tree, head: Word, verb: Word) -> list[Word]:
    """Return a predicate adjective with its measure (*20 years old*) and the prepositional phrase directly after it.

    It does not matter whether the parser attaches the prepositional phrase to the adjective or to the verb.
    """
    kept = [head]
    for child in tree.children(head, "npadvmod", "compound"):
        kept += noun_phrase(tree, child) if child.index < head.index else []
    after = tree.after(head)
    if after is not None and after.dep in ("prep", "agent") and after.head in (head.index, verb.index):
        kept += noun_phrase(tree, after, joined=True) if tree.children(after, "pobj", "pcomp") else []
    return _with_hyphens(tree, kept)


def gerund_phrase(tree: Tree, head: Word) -> list[Word]:
    """Return all words of a gerund phrase (*playing chess*), without determiners and punctuation."""
    words = [word for word in tree.subtree(head) if word.pos != "PUNCT"]
    return [word for word in words if word.dep not in ("det", "predet") or word.low not in DETERMINERS]


def conjuncts(tree: Tree, head: Word, clauses: Container[int]) -> list[Word]:
    """Return `head` with its conjuncts. Leave out verbs whose indices are in `clauses`."""
    found = [head]
    for word in found:  # the list grows in the loop
        # As in "a cat, a dog and a bird".
        listed = [child for child in tree.children(word, "appos") if child.pos == word.pos]
        joined = [child for child in listed if tree.children(child, "conj")] + tree.children(word, "conj")
        found += [child for child in joined if child.index not in clauses]
    return found


def _belongs(tree: Tree, child: Word, head: Word) -> bool:
    """Return whether `child`, with its own dependents, belongs to the phrase around `head`."""
    if child.dep == "appos":  # a name without a comma, perhaps in lower case, as in "my friend tom"
        comma = any(between.pos == "PUNCT" for between in tree.words[head.index : child.index])
        return not comma and (child.pos == "PROPN" or (child.tag == "NN" and child.index == head.index + 1))
    if child.low in DETERMINERS and child.dep not in ("pobj", "pcomp"):
        return (child.low, head.low) in _PRONOUNS
    after = child.dep == "amod" and child.index > head.index  # as in "are cats nice"
    return child.dep in _KEPT and (child.pos != "ADV" or child.dep == "pobj") and not after


def _with_hyphens(tree: Tree, kept: list[Word]) -> list[Word]:
    """Add words joined by hyphens: the pipeline splits *well-known* into three."""
    indices = {word.index for word in kept}
    for word in kept:
        indices |= {word.index + step for step in range(1, 5) if _in_law(tree, word)}
    for index in range(len(tree.words) - 1, 1, -1):
        hyphen = tree.words[index - 1]
        if index in indices and hyphen.low in "-–" and hyphen.end == tree.words[index].start:
            indices |= {index - 1, index - 2}
    return [tree.words[index] for index in sorted(indices)]


def _in_law(tree: Tree, noun: Word) -> str:
    """Return the rest of *sister-in-law*, which the pipeline splits; empty after other nouns."""
    return "-in-law" if tree.text[noun.end :].lower().startswith("-in-law") else ""


def _names_in(tree: Tree, head: Word) -> list[str]:
    """Return the names in a phrase: its head, appositions, and *named Rosa*."""
    if head.pos == "PROPN":
        parts = [word for word in tree.children(head, "compound", "flat") if word.pos == "PROPN"]
        name = tree.phrase([head, *(word for word in parts if not _is_common(tree, word, head))])
        joined = tree.children(head, "conj") if head.dep == "appos" else []
        return [name, *(name for word in joined for name in _names_in(tree, word))]
    called = [word for word in tree.children(head, "acl", "relcl") if word.low in ("named", "called")]
    named = [*tree.children(head, "appos"), *tree.children_of(called, "oprd", "dobj", "attr")]
    return [name for word in named for name in _names_in(tree, word)] if head.pos == "NOUN" else []


def _is_common(tree: Tree, word: Word, head: Word) -> bool:
    """Return whether a word before a name is no part of the name: *nan*, in *my nan Pearl*."""
    return word.text.islower() and head.text.istitle() and bool(tree.children(head, "poss"))


def _amount(tree: Tree, head: Word) -> float | None:
    """Return the number before the head: *two sisters*, *34 years old*."""
    for word in [*tree.children(head), *tree.children_of(tree.children(head, "npadvmod"))]:
        if word.dep in ("nummod", "det", "compound") and word.low in _NUMBERS:
            return float(_NUMBERS.index(word.low))
        if word.dep == "nummod" and word.low.replace(",", "").replace(".", "", 1).isdecimal():
            return float(word.low.replace(",", ""))
    return None
