"""Changes of known facts: facts that a statement ends, and facts that the user corrects in a few words."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

from ravestate.modules import nlp

from .answers import answer, spelled_out
from .kinds import likeness
from .links import Link, predicate_of
from .topics import NOUNS, TOPICS, WORDS, Fact
from .values import gerund, number_in, value_of
from .wording import Facts, alike, same

if TYPE_CHECKING:
    from .reading import Reader

_FIXED = re.compile(
    r"\b(?:with (?:an? )?[\w-]+\b(?! and)|actually|in fact|sp(?:elled|elt)|misspel\w+|said|meant|mean|wrong|mistake|nope?|nah|sorry|not|"
    r"rather|correction)\b",
    re.IGNORECASE,
)
"""Words with which a user corrects the spelling or the sound of a value."""
_NAMED = re.compile(r"^.*\b(?:is|are|am|was|said|meant|mean|called|named|in|from|it's|its)\s+", re.IGNORECASE)
ALIKE = 0.6
"""The least share of common letters of a value and the value for which it was mistaken: *Lora*, *Nora*."""


def ended_by(reader: Reader, said: nlp.Statement, known: Facts) -> dict[str, tuple[str, ...]]:
    """Return the values by topic that a statement ends: *I gave up chess*, *I left the choir*, *Sven and I broke up*.

    A topic without values ends as a whole: *I quit my job*.
    """
    predicate, object = predicate_of(said), said.object
    if said.subject.person != "I":
        return {}
    if topic := reader.ended(said):
        place = next((phrase for phrase in said.phrases if phrase.preposition in ("at", "with", "for")), None)
        employer = value_of(reader.written(place), TOPICS["employer"], reader.seen) if place else None
        return {"employer": (employer,)} if topic == "occupation" and employer else {topic: ()}
    words = predicate.split()
    over = (said.negated and reader.words & {"more", "anymore", "longer"}) or words[0] == "use"
    ends = next((verb for verb in WORDS["ending"] if verb in (predicate, *words[:1], " ".join(words[-2:]))), "")
    if not (over or (ends and not said.negated)):
        return {}
    done = gerund(reader.span(said), reader.seen)
    things = list(filter(None, (object.text, done, gerund(said.verb, reader.seen))))
    found = {
        topic: meant
        for topic, values in known.items()
        if (meant := tuple(value for value in values if alike(value, things)))
    }
    if found or over:
        return found
    if ends in WORDS["parting"]:
        text = reader.tree.text.lower()
        partners = {topic: known[topic] for topic in ("partner", "wife", "husband") if known.get(topic)}
        return {topic: values for topic, values in partners.items() if any(value.lower() in text for value in values)}
    topic = NOUNS.get(object.head, "")
    if (
        topic
        and TOPICS[topic].kind == "organisation"
        and (value := value_of(reader.written(object), TOPICS[topic], reader.seen))
    ):
        return {topic: (value,)}
    activity = object.text if object.text.endswith("ing") else done.partition(" ")[2] if "ing" in done else ""
    is_hobby = ends in WORDS["habit_ending"] and activity and likeness(activity, "activity") > 0
    return {"hobby": (activity,)} if is_hobby else {}


def renamed_in(said: nlp.Statement, known: Facts) -> Iterator[Link]:
    """Yield the new topic of a known person or pet: *Felix is a dog*, if the agent took Felix for a cat."""
    topic = NOUNS.get(said.object.head, "")
    if said.verb == "be" and topic and TOPICS[topic].kind == "people" and said.object.owner is None:
        kinds = [one for one in known if TOPICS[one].kind == "people" and one != topic]
        if any(same(said.subject.text, value) for one in kinds for value in known[one]):
            yield Link(topic, said.subject)


def amended(text: str, known: Facts, seen: nlp.Analysis) -> list[Fact]:
    """Return the correction of a known value that a text denies or resembles: *not Bremen, Hannover*, *Lora with an L*."""
    if seen.question is not None:
        return []
    text = spelled_out(text)
    for topic, values in known.items():
        for value in values:
            denied = re.search(
                rf"[,;.!?]*\s*\bnot (?:(?:an?|the|in|from|at|for) )?{re.escape(value)}\b[,;.!?]*\s*",
                text,
                re.IGNORECASE,
            )
            if denied:
                before, after = text[: denied.start()], text[denied.end() :]
                for part in (after, before):
                    if re.search(r"\byou\b", part, re.IGNORECASE):
                        continue
                    if facts := answer(_NAMED.sub("", part), topic, seen):
                        gone = [Fact(topic, (value,), gone=True)] if _is_one_of_several(topic) else []
                        return [*facts[:1], *gone]
            elif value.lower() not in text.lower() and _FIXED.search(text) and (new := _resembling(value, topic, seen)):
                return [Fact(topic, (new,)), *([Fact(topic, (value,), gone=True)] if _is_one_of_several(topic) else [])]
            elif value.lower() in text.lower() and any(
                re.search(rf"\bnot (?:an?|my) {noun}\b", text) for noun in TOPICS[topic].nouns
            ):
                return [Fact(topic, (value,), gone=True)]  # "Tom is my cousin, not a friend"
    return []


def _is_one_of_several(topic: str) -> bool:
    """Return whether a new value leaves the old value in memory, so that a correction must remove it."""
    return TOPICS[topic].many or TOPICS[topic].kind == "people"


def _resembling(value: str, topic: str, seen: nlp.Analysis) -> str:
    """Return the word of an utterance that sounds like a known value; empty if there is none."""
    about = TOPICS[topic]
    for word in seen.tree.words:
        if about.kind == "number":
            new = number_in(word.low) if word.pos == "NUM" else ""
            if new and new != value and word.index < 3:
                return new
        elif word.pos in ("PROPN", "NOUN", "X") and len(word.text) > 2 and not same(word.text, value):
            near = SequenceMatcher(None, word.low, value.lower()).ratio() >= ALIKE
            if near and (new := value_of(word.text, about, seen)):
                return new
    return ""
