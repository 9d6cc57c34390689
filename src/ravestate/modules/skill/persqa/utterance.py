"""An utterance: its words, and the topics that its phrases name. `Reader` and its helpers read facts from it."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.tree import Tree, Word

from .link import Link
from .topics import NAME, NOUNS, TOPICS, WORDS, favourite
from .values import value_of
from .wording import Facts

MINE = frozenset(["mine", "ours"])
"""Subjects that stand for something of the user's: *mine is Ada*, after *which dog is yours?*."""
_NONE = frozenset(["none", "neither", "nobody"])


class Utterance:
    """An utterance, with what is known of the user when it comes.

    Args:
        seen: The analysis of the utterance.
        asked: The topic of the agent's open question, or an empty string.
        person: The topic of the relative whom *he* or *his* means, or an empty string.
        known: The earlier facts.
        recent: The topic that the user or the agent mentioned in the last utterances, or an empty string.
    """

    def __init__(
        self, seen: nlp.Analysis, asked: str = "", person: str = "", known: Facts | None = None, recent: str = ""
    ) -> None:
        self.seen, self.tree, self.known, self.recent = seen, seen.tree, known or {}, recent
        self.words = {word.low for word in seen.tree.words}
        self.denies_all = bool(self.words & _NONE)
        self.mistaken = not self.words.isdisjoint({"mistake", "mistakenly", "wrongly"})  # "she calls me Al by mistake"
        self.asked = asked
        self.was_child = any(
            one.subject.person == "I" and one.verb == "be" and one.past and one.object.head in WORDS["young"]
            for one in seen.statements
        )  # "when I was a kid, we lived in Rome"
        mine = (said.object for said in seen.statements if said.subject.person == "I" or said.object.of("I"))
        owned = (self.relative(object.head) for object in mine)
        self.person = person or next(filter(None, owned), "")

    def noun(self, phrase: Phrase) -> str:
        """Return the topic of *my job*, *my sister's name*, *my favourite food*; empty for other phrases."""
        owner = phrase.owner
        if phrase.text.lower() in MINE:
            return self.asked
        if phrase.text.lower() == "name":  # "name is Ada, the name's Ada"
            return NAME
        theirs = owner and owner.text.lower() in ("his", "her") and phrase.head == "name"
        if theirs or phrase.text.lower() in ("he", "she"):
            return self.person
        if (bare := NOUNS.get((owner or phrase).text.lower())) in ("mother", "father") and phrase.head.lower() in (
            "name",
            "",
            phrase.text.lower(),
        ):
            return bare  # "mum's name is Ann"
        if owner is None or not phrase.of("I") or is_former(phrase.text):
            return ""
        if self.relative(phrase.head) and (owner.person != "I" or self._has_owner(phrase)):
            return ""  # "my friend's dog"
        if (phrase.head == "name" and owner.person != "I") or (phrase.head == "one" and owner.owner is not None):
            return self.noun(owner)  # "my sister's name, one of my hobbies"
        low = phrase.text.lower()
        if phrase.head == "name" and (relative := self.relative(low.split()[-2].removesuffix("s"))):
            return relative  # "my dogs name"
        topic = NOUNS.get(" ".join(low.split()[-2:])) or NOUNS.get(phrase.head, "")
        best = re.search(r"\bfavou?rite .+", low)
        if best and phrase.head[:3] in best[0] and topic != "hobby":
            return favourite(re.sub(r"\w+$", phrase.head, best[0]) if best[0].endswith(f"{phrase.head}s") else best[0])
        return topic

    def _has_owner(self, phrase: Phrase) -> bool:
        words = [word for word in self.tree.words if word.lemma == phrase.head and word.text in phrase.text]
        return any(owner_before(word, self.tree) for word in words)

    def has(self, said: nlp.Statement) -> bool:
        """Return whether the user says that they have something: *I have*, *I've got*."""
        got = said.verb == "get" and any(word.low == "got" for word in self.tree.words)
        return said.subject.person == "I" and (said.verb in ("have", "own") or got)

    def relative(self, noun: str) -> str:
        """Return the topic of a relative, a friend or a pet; empty for other nouns."""
        topic = NOUNS.get(noun, "")
        return topic if topic and TOPICS[topic].kind == "people" else ""

    def values(self, link: Link, *, denied: bool = False) -> tuple[str, ...]:
        """Return the values of a link's topic in the link's phrase."""
        topic, phrase = TOPICS[link.topic], link.phrase
        if phrase is None:
            return ()
        if topic.kind in ("people", "name") and phrase.head == "name" and phrase.owner:
            phrase = phrase.owner  # "by the name of Blackbeard"
        named = topic.kind == "people" or (topic.kind in ("place", "organisation") and phrase.head)
        raw = (phrase.names if named else ()) or (link.value or self.written(phrase),)  # "a small island, Naxos"
        return self.fitting(link.topic, raw, sure=(link.sure and not denied) or link.topic == self.asked == NAME)

    def fitting(self, topic: str, raw: Iterable[str], *, sure: bool = True) -> tuple[str, ...]:
        """Return the texts that can be values of a topic, in memory's spelling."""
        return tuple(filter(None, (value_of(text, TOPICS[topic], self.seen, sure=sure) for text in raw)))

    def verb(self, said: nlp.Statement) -> Word | None:
        """Return the verb of a statement in the tree."""
        last = said.triple.predicate.split()[-1]
        verbs = [word for word in self.tree.words if word.low == last or word.lemma == said.verb]
        return min(verbs, key=lambda word: word.pos not in ("VERB", "AUX"), default=None)

    def is_denied(self, said: nlp.Statement) -> bool:
        """Return whether a clause above a statement denies it: *it's not like I left*, *it's not true that I left*."""
        verb = self.verb(said)
        marks = [] if verb is None else [word.low for word in self.tree.children(verb, "mark")]
        if verb is None or verb.dep not in ("advcl", "ccomp", "acl") or not {"like", "that"}.intersection(marks):
            return False
        above = next((word for word in self.tree.ancestors(verb) if word.lemma in ("be", "'s")), None)
        return above is not None and bool(self.tree.children(above, "neg"))

    def written(self, phrase: Phrase) -> str:
        """Return a phrase with its article, as in the utterance."""
        inner = r"\s+(?:(?:the|an?)\s+)?".join(map(re.escape, phrase.text.split()))
        articles = r"(?:(?:the|an?|our|this|that|these|those)\s+)?"
        name = r"(?:-[\w-]+|\s&\s\w+|\s(?:am|an der|upon|de|del)\s\w+)*"  # "Stoke-on-Trent, Frankfurt am Main"
        found = re.search(rf"(?<![\w']){articles}{inner}(?!\w){name}", self.tree.text, re.IGNORECASE)
        return found[0] if found else phrase.name or phrase.text

    def span(self, said: nlp.Statement) -> str:
        """Return the last verb of a statement, its object, and the words between them."""
        verb = self.verb(said)
        return self.span_of(verb.low, said.object) if verb else ""

    def span_of(self, verb: str, object: Phrase) -> str:
        """Return a verb, its object, and the words between them."""
        end = rf"(?:.{{0,40}}?{re.escape(object.text)})?"
        found = re.search(rf"\b{re.escape(verb)}\w*\b{end}", self.tree.text, re.IGNORECASE)
        return found[0] if found else ""


def is_former(words: str) -> bool:
    """Return whether words are about somebody or something that is not the user's now: *my ex wife*."""
    return bool(WORDS["former"] & set(re.split(r"\W", words.lower())))


def owner_before(word: Word, tree: Tree) -> Word | None:
    """Return the person before a noun, to whom it belongs: *friend*, in *my friend's cat*, *my friends cat*."""
    for owner in tree.children(word, "poss", "compound"):
        if owner.pos in ("NOUN", "PROPN") and (owner.dep == "poss" or owner.tag == "NNS"):
            return owner
    return None
