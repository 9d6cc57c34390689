"""Corrections by sound or spelling (*Lora with an L*), and utterances that may correct a fact.

A correction by sound or spelling works only for a fact that the user or the agent has just mentioned. ``contrast.py``
reads all other corrections.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from difflib import SequenceMatcher

from ravestate.modules import nlp

from .reading import Reader
from .topics import TOPICS, WORDS, Fact
from .values import number_in, value_of

_FIXED = re.compile(
    r"\b(?:with (?:\w+ )?[a-z](?:['’]?s)?(?=$|[,.;!]| (?:and|not|please)\b)|actually|said|meant|mean|sp(?:elled|elt)|"
    r"misspel\w+|wrong)\b",
    re.IGNORECASE,
)
"""Words with which a user corrects the spelling or the sound of a value."""
_PARTLY = re.compile(r"(?:n['’]t|\bnot) (?:just|only|merely|simply)\b", re.IGNORECASE)
ALIKE = 0.6
"""The least share of letters that two values have in common if one was mistaken for the other: *Lora*, *Nora*."""


def is_partial(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether a negation denies only a part of a statement: *I'm not just a nurse*, *I don't row because it's cheap*."""
    lasting = {"more", "longer", "anymore"} & reader.words
    reason = "because" in reader.words and not lasting and said.verb != "be"
    return said.negated and (reason or _PARTLY.search(reader.tree.text) is not None)


def is_brief(said: nlp.Statement) -> bool:
    """Return whether a statement holds only for a while: *I quit Bosch for the day*."""
    return any(one.preposition == "for" and one.head in WORDS["leisure"] for one in said.phrases)


def may_correct(seen: nlp.Analysis, topic: str) -> bool:
    """Return whether an utterance may correct a fact just mentioned: its only verbs are *say*, *mean* and the like."""
    opposed = {text for one in seen.contrasts for text in (one.right.text, one.wrong.text)}  # the parser may see verbs
    finite = {
        word.lemma for word in seen.tree.words if word.tag in ("VBD", "VBZ", "VBP", "MD") and word.text not in opposed
    }
    people = TOPICS[topic].kind in ("people", "name")
    pronouns = ("", "i", "it", "that", "this", *(("he", "she", "they") if people else ()))
    nouns = (*TOPICS[topic].nouns, *(["name"] if people else []))
    if finite - WORDS["speaking"]:
        return False
    for said in seen.statements if finite else ():
        if said.verb == "wait":
            continue
        owner = said.subject.owner
        own = owner is None or owner.person == "I" or owner.text.lower() in ("his", "her", "its", "their")
        noun = own and said.subject.head in nouns
        named = said.subject.text.lower() in pronouns or noun
        more = {one.preposition for one in said.phrases} - {"", "with", "in", "from", "at", "for", "as"}
        if not named or more or said.question:
            return False
    return seen.question is None


def misheard(text: str, topic: str, latest: Collection[str], seen: nlp.Analysis) -> list[Fact]:
    """Return the value that the user repeats more clearly, just after the agent understood `latest`: *Lora with an L*.

    The list is empty if there is no such value.
    """
    if not _FIXED.search(text.rstrip(".!? ")):
        return []
    objects = [said.object.text for said in seen.statements if said.object.text]
    for word in seen.tree.words:
        near = any(is_similar(word.low, value) for value in latest)
        number = TOPICS[topic].kind == "number" and word.pos == "NUM" and number_in(word.low)
        named = near and word.pos in ("PROPN", "NOUN", "X")
        after = next((one.pos for one in seen.tree.words[word.index + 1 :] if one.pos != "DET"), "PUNCT")
        whole = after == "PUNCT" if number else after not in ("NOUN", "PROPN", "NUM")  # not "6 times"
        if (
            (number or named)
            and whole
            and objects in ([], [word.text])
            and (new := value_of(word.text, TOPICS[topic], seen))
        ):
            return [Fact(topic, (new,))]
    return []


def is_similar(one: str, other: str) -> bool:
    """Return whether two different values are spelled almost alike: *Lora*, *Nora*."""
    one, other = one.lower(), other.lower()
    return one != other and SequenceMatcher(None, one, other).ratio() >= ALIKE
