"""Changes of known facts: the only place where an utterance ends a fact, or replaces its value by another.

A change needs an owner and a role. The owner: the user is the subject, and nobody reports the statement. The role: the verb
ends facts of this topic, and the value itself is its object. Without a role (*no, Bremen*, *Lora with an L*), the agent or
the user must have mentioned the fact in the last utterances. Everything else leaves the facts alone.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

from ravestate.modules import nlp

from .links import NOW, Link, predicate_of
from .topics import NOUNS, TOPICS, WORDS, Fact
from .values import gerund, number_in, value_of
from .wording import same

if TYPE_CHECKING:
    from .reading import Reader

_FIXED = re.compile(r"\b(?:with (?:an? )?\w+$|actually|said|meant|mean|sp(?:elled|elt)|misspel\w+|wrong)\b", re.IGNORECASE)
"""Words with which a user corrects the spelling or the sound of a value."""
ALIKE = 0.6
"""The least share of common letters of a value and the value for which it was mistaken: *Lora*, *Nora*."""


def ended_by(reader: Reader, said: nlp.Statement) -> dict[str, tuple[str, ...]]:
    """Return the values by topic that a statement ends: *I gave up chess*, *I left the choir*, *Sven and I broke up*.

    A topic without values ends as a whole: *I quit my job*.
    """
    if said.subject.person != "I":
        return {}
    if topic := reader.ended(said):
        place = next((phrase for phrase in said.phrases if phrase.preposition in ("at", "with", "for")), None)
        employer = value_of(reader.written(place), TOPICS["employer"], reader.seen) if place else None
        return {"employer": (employer,)} if topic == "occupation" and employer else {topic: ()}
    if said.negated or _is_embedded(reader, said):
        return {}
    predicate = predicate_of(said).removeprefix("have to ")
    first, _, second = predicate.partition(" ")
    verb = first if second.endswith("ing") else predicate
    ended = {
        topic: tuple(value for value in values if _is_object(reader, said, topic, value))
        for topic, values in reader.known.items()
        if verb in WORDS.get(_ending(topic), ())
    }
    return {topic: values for topic, values in ended.items() if values}


def _ending(topic: str) -> str:
    """Return the list of verbs that end facts of a topic."""
    about = TOPICS[topic]
    if about.relation == "partner_of" or about.type == "Animal":
        return "ending_partner" if about.type == "Person" else "ending_pet"
    return "ending_activity" if about.kind in ("activity", "thing", "subject") else f"ending_{about.kind}"


def _is_embedded(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether a clause depends on another: *it's not like I left Bosch*."""
    verb = reader.verb(said)
    while verb is not None and verb.dep in ("xcomp", "conj"):
        verb = reader.tree.head(verb)
    return verb is None or verb.dep in ("ccomp", "advcl", "relcl", "acl")


def _is_object(reader: Reader, said: nlp.Statement, topic: str, value: str) -> bool:
    """Return whether a value is all that a statement is about, apart from a time."""
    others = [phrase for phrase in (said.object, *said.phrases) if phrase.text and phrase.text not in said.when]
    if TOPICS[topic].relation == "partner_of":
        both = re.search(
            rf"\b{re.escape(value)} and (?:i|me)\b|\b(?:i|me|we) and {re.escape(value)}\b", reader.tree.text, re.IGNORECASE
        )
        return all(same(phrase.text, value) for phrase in others) and bool(both or others)
    brief = any(entity.label == "TIME" for entity in reader.seen.entities) or reader.words & {"early", "late", *NOW}
    if any(phrase.text != said.object.text for phrase in others) or (brief and said.verb == "leave"):
        return False
    things = (said.object.text, gerund(reader.span(said), reader.seen), gerund(said.verb, reader.seen))
    last = value.split()[-len(said.object.text.split()) :]  # "the choir", if the value is "local choir"
    return any(same(value, one) for one in things if one) or (last != [] and same(" ".join(last), said.object.text))


def switched_in(reader: Reader, said: nlp.Statement) -> Link | None:
    """Return the new value in *I switched from law to physics*, *I changed my major to physics*."""
    new = next((phrase for phrase in said.phrases if phrase.preposition == "to"), None)
    if said.verb not in WORDS["changing"] or new is None or said.negated:
        return None
    old = next((phrase.text for phrase in said.phrases if phrase.preposition == "from"), "-")
    topics = [topic for topic, values in reader.known.items() if any(same(old, value) for value in values)]
    noun = NOUNS.get(said.object.head, "") if said.object.of("I") else ""
    recent = reader.recent if reader.recent in WORDS["changeable"] and said.object == new else ""
    topic = next(iter(topics), noun or recent)
    return Link(topic, new) if topic else None


def renamed_in(reader: Reader, said: nlp.Statement) -> Iterator[tuple[str, str, str]]:
    """Yield the old topic, the new topic and the name of somebody known: *Felix is a dog*, if he was taken for a cat.

    The new topic is empty if the user only denies the old topic: *Tom is my cousin, not a friend*."""
    name, object = said.subject.text, said.object
    new = reader.relative(object.head) if object.owner is None or object.of("I") else ""
    for topic, values in reader.known.items() if said.verb == "be" and not said.question else ():
        if TOPICS[topic].kind != "people" or topic == new or not any(same(name, value) for value in values):
            continue
        nouns = "|".join(map(re.escape, TOPICS[topic].nouns))
        denied = re.search(rf"\bnot (?:an?|my) (?:{nouns})\b", reader.tree.text, re.IGNORECASE)
        plain = object.text == object.head and new and TOPICS[new].type == TOPICS[topic].type == "Animal"
        if denied or plain:
            yield topic, new, name


def denied_beside(reader: Reader, topic: str, told: Collection[str]) -> tuple[str, ...]:
    """Return the known values that a statement with another value of the topic denies: *Pia, not Mia, is my sister*."""
    pattern = r"\bnot (?:(?:an?|the|in|from|at|for|my) )?{}\b"
    return tuple(
        value
        for value in reader.known.get(topic, ())
        if value not in told and re.search(pattern.format(re.escape(value)), reader.tree.text, re.IGNORECASE)
    )


def misheard(text: str, topic: str, latest: Collection[str], seen: nlp.Analysis) -> list[Fact]:
    """Return the value that the user repeats more clearly, just after the agent understood `latest`: *Lora with an L*."""
    speaking = ("say", "mean", "be", "spell", "call")
    subjects = ("i", "it", "that", "the name", "my name", *map(str.lower, latest))
    apart = any(said.verb not in speaking or said.subject.text.lower() not in subjects for said in seen.statements)
    if apart or seen.question is not None or not _FIXED.search(text.rstrip(".!? ")):
        return []
    for word in seen.tree.words:
        for value in latest:
            near = SequenceMatcher(None, word.low, value.lower()).ratio() >= ALIKE and not same(word.text, value)
            number = TOPICS[topic].kind == "number" and word.pos == "NUM" and number_in(word.low)
            if (number or (near and word.pos in ("PROPN", "NOUN", "X"))) and (
                new := value_of(word.text, TOPICS[topic], seen)
            ):
                return [Fact(topic, (new,))]
    return []
