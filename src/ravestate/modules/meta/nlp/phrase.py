"""A phrase: the subject or object of a statement, or another noun phrase of its clause."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .noun_phrase import noun_phrase
from .tree import Tree, Word
from .word_set import word_set

Person = Literal["I", "you", "other"]
"""The speaker (*I, my, we*), the agent (*you, your*), or others."""


@dataclass(frozen=True, slots=True)
class Phrase:
    """A noun phrase with the parts that skills use.

    Example:
        *my two sisters* has the head ``sister``, the owner *my* (person ``I``), and the amount 2. *my sister Rosa* has
        the head ``sister`` and the name ``Rosa``; *Rosa* has no head.
    """

    text: str
    """As in the triple: ``my sister Rosa``."""
    head: str = ""
    """The lemma of the common noun or adjective, in lower case: ``sister``; empty for names and pronouns."""
    names: tuple[str, ...] = ()
    """The names in the phrase, as written: ``("Rosa",)``; *two brothers, Max and Tim* has two."""
    owner: Phrase | None = None
    """The possessor: *my*; *my mother* for *my mother's name*; *Peru* for *the capital of Peru*."""
    amount: float | None = None
    """The number before the head: 2 for *two sisters*, 0 for *no sisters*, 34 for *34 years old*."""
    person: Person = "other"
    """``I`` and ``you`` for pronouns; ``other`` for everything else, also for *my sister*."""
    preposition: str = ""
    """The preposition before it, in lower case: ``in``."""

    @property
    def name(self) -> str:
        """The first name, or an empty string."""
        return self.names[0] if self.names else ""

    def of(self, person: Person) -> bool:
        """Return whether it belongs to `person`: *my sister* and *my mother's name* to ``I``."""
        return self.owner is not None and (self.owner.person == person or self.owner.of(person))


_SPEAKER = word_set("i me my mine myself we us our ours ourselves")
_AGENT = word_set("you your yours yourself u ur")
_NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]


def phrase_of(tree: Tree, head: Word, words: list[Word]) -> Phrase:
    """Return the phrase of `words` around `head`."""
    noun = None if head.pos in ("PRON", "DET") else head
    if head.pos == "PROPN":  # friend, of my friend Anna
        noun = next((word for word in tree.children(head, "compound", "nmod") if word.pos == "NOUN"), None)
    of = [word for word in tree.children(noun or head, "prep") if word.low == "of"]
    owners = [*tree.children(noun or head, "poss"), *tree.children_of(of, "pobj")]
    return Phrase(
        tree.phrase(words),
        head="" if noun is None else noun.lemma.lower() if noun.pos == "NOUN" else noun.low,
        names=tuple(_names_in(tree, head)),
        owner=_owner(tree, owners[0]) if owners else None,
        amount=_amount(tree, head),
        person=person_of(head),
        preposition=tree.head(head).low if head.dep in ("pobj", "pcomp") else "",
    )


def person_of(word: Word) -> Person:
    """Return the person of a pronoun; *other* for other words."""
    return "I" if word.low in _SPEAKER else "you" if word.low in _AGENT else "other"


def _owner(tree: Tree, head: Word) -> Phrase:
    return phrase_of(tree, head, [word for word in noun_phrase(tree, head) if word.dep != "case"])


def _names_in(tree: Tree, head: Word) -> list[str]:
    """Return the names in a phrase: its head, appositions, and *named Rosa*."""
    if head.pos == "PROPN":
        name = tree.phrase([head, *(word for word in tree.children(head, "compound", "flat") if word.pos == "PROPN")])
        joined = tree.children(head, "conj") if head.dep == "appos" else []
        return [name, *(name for word in joined for name in _names_in(tree, word))]
    called = [word for word in tree.children(head, "acl", "relcl") if word.low in ("named", "called")]
    named = [*tree.children(head, "appos"), *tree.children_of(called, "oprd", "dobj", "attr")]
    return [name for word in named for name in _names_in(tree, word)] if head.pos in ("NOUN", "PROPN") else []


def _amount(tree: Tree, head: Word) -> float | None:
    """Return the number before the head: *two sisters*, *34 years old*."""
    for word in [*tree.children(head), *tree.children_of(tree.children(head, "npadvmod"))]:
        if word.dep in ("nummod", "det", "compound") and word.low in _NUMBERS:
            return float(_NUMBERS.index(word.low))
        if word.dep == "nummod" and word.low.replace(",", "").replace(".", "", 1).isdecimal():
            return float(word.low.replace(",", ""))
    return None
