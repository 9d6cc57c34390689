"""Changes of known facts: statements that end a fact, or replace its value by another.

A statement changes a fact under two conditions. First, the user is its subject, and it is not reported speech. Second,
its verb ends facts of this topic, with the value itself as the object. A correction by sound or spelling (*Lora with an
L*) works only for a fact that the user or the agent has just mentioned. ``contrast.py`` reads all other corrections.
Other utterances change no facts.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from difflib import SequenceMatcher

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase

from .link import Link
from .links import NOW, predicate_of
from .topics import ENDS, NOUNS, TOPICS, WORDS, Fact
from .utterance import Utterance
from .values import gerund, number_in, value_of
from .wording import same

_FIXED = re.compile(
    r"\b(?:with (?:\w+ )?[a-z](?:['’]?s)?(?=$|[,.;!]| (?:and|not|please)\b)|actually|said|meant|mean|sp(?:elled|elt)|"
    r"misspel\w+|wrong)\b",
    re.IGNORECASE,
)
"""Words with which a user corrects the spelling or the sound of a value."""
_PARTLY = re.compile(r"(?:n['’]t|\bnot) (?:just|only|merely|simply)\b", re.IGNORECASE)
ALIKE = 0.6
"""The least share of common letters of two values of which one was mistaken for the other: *Lora*, *Nora*."""


def ended_by(reader: Utterance, said: nlp.Statement) -> dict[str, tuple[str, ...]]:
    """Return the values by topic that a statement ends: *I gave up chess*, *I left the choir*, *Sven and I broke up*.

    A topic without values ends as a whole: *I quit my job*.
    """
    if said.subject.person != "I":
        return {}
    predicate = predicate_of(said)
    whole = f"{'not ' * said.negated}{predicate} {said.object.head or said.object.text.lower()}".strip()
    if (topic := ENDS.get(whole)) and not said.past and not is_limited(reader, said):
        place = next((phrase for phrase in said.phrases if phrase.preposition in ("at", "with", "for")), None)
        employer = value_of(reader.written(place), TOPICS["employer"], reader.seen) if place else None
        return {"employer": (employer,)} if topic == "occupation" and employer else {topic: ()}
    if said.negated or _is_embedded(reader, said) or is_limited(reader, said) or is_brief(said):
        return {}
    predicate = predicate.removeprefix("have to ")
    first, _, second = predicate.partition(" ")
    verbs = {
        first if second.endswith("ing") else predicate,
        f"{predicate} {said.object.preposition or said.object.text}",
    }
    ended = {
        topic: tuple(value for value in values if _is_object(reader, said, topic, value))
        for topic, values in reader.known.items()
        if verbs & WORDS.get(_ending(topic), frozenset())
    }
    return {topic: values for topic, values in ended.items() if values}


def _ending(topic: str) -> str:
    """Return the name of the list in `WORDS` with the verbs that end facts of a topic."""
    about = TOPICS[topic]
    if about.relation == "partner_of" or about.type == "Animal":
        return "ending_partner" if about.type == "Person" else "ending_pet"
    return "ending_activity" if about.kind in ("activity", "thing", "subject") else f"ending_{about.kind}"


def _is_embedded(reader: Utterance, said: nlp.Statement) -> bool:
    """Return whether a clause depends on another: *it's not like I left Bosch*."""
    verb = reader.verb(said)
    while verb is not None and verb.dep in ("xcomp", "conj"):
        verb = reader.tree.head(verb)
    return verb is None or verb.pos not in ("VERB", "AUX") or verb.dep in ("ccomp", "advcl", "relcl", "acl")


def _is_object(reader: Utterance, said: nlp.Statement, topic: str, value: str) -> bool:
    """Return whether a value is all that a statement is about, apart from a time."""
    others = [
        phrase for phrase in (said.object, *said.phrases) if phrase.text and phrase.text not in f"divorced {said.when}"
    ]
    if TOPICS[topic].relation == "partner_of":
        both = re.search(
            rf"\b{re.escape(value)} and (?:i|me)\b|\b(?:i|me|we) and {re.escape(value)}\b",
            reader.tree.text,
            re.IGNORECASE,
        )
        return all(same(phrase.text, value) for phrase in others) and bool(both or others)
    brief = any(entity.label == "TIME" for entity in reader.seen.entities)
    if any(phrase.text != said.object.text for phrase in others) or (brief and said.verb == "leave"):
        return False
    if _has_more(reader, said):
        return False
    things = (said.object.text, gerund(reader.span(said), reader.seen), gerund(said.verb, reader.seen))
    last = value.split()[-len(said.object.text.split()) :]  # "the choir", if the value is "local choir"
    return any(same(value, one) for one in things if one) or (last != [] and same(" ".join(last), said.object.text))


def _has_more(reader: Utterance, said: nlp.Statement) -> bool:
    """Return whether a verb has a second object or a purpose: *I left Bosch a note*, *I stopped running to rest*."""
    verb = reader.verb(said)
    verbs = [verb, *reader.tree.ancestors(verb)] if verb else []
    purposes = [word for word in reader.tree.children_of(verbs, "advcl", "xcomp") if word not in verbs]
    purposes = [word for word in purposes if word.lemma not in WORDS["careers"]]
    infinitive = any(word.low == "to" for word in reader.tree.children_of(purposes, "aux"))
    return infinitive or any(len(reader.tree.children(one, "dobj", "dative", "oprd")) > 1 for one in verbs)


def switched_in(reader: Utterance, said: nlp.Statement) -> Link | None:
    """Return the new value in *I switched from law to physics*, *I changed my major to physics*."""
    new = next((phrase for phrase in said.phrases if phrase.preposition == "to"), None)
    others = [
        phrase for phrase in said.phrases if phrase.preposition not in ("from", "to") and phrase.text not in said.when
    ]
    if said.verb not in WORDS["changing"] or new is None or said.negated or others:
        return None
    old = next((phrase.text for phrase in said.phrases if phrase.preposition == "from"), "-")
    topics = [topic for topic, values in reader.known.items() if any(same(old, value) for value in values)]
    noun = NOUNS.get(said.object.head, "") if said.object.of("I") else ""
    recent = reader.recent if reader.recent in WORDS["changeable"] and said.object == new else ""
    topic = next(iter(topics), noun or recent)
    return Link(topic, new, sure=False) if topic in WORDS["changeable"] else None


def renamed_in(reader: Utterance, said: nlp.Statement) -> Iterator[tuple[str, str, str]]:
    """Yield the old topic, the new topic and the name of a person or pet: *Rex is a dog*, if Rex was taken for a cat.

    The new topic is empty if the user only denies the old topic: *Tom is my cousin, not a friend*."""
    name, object = said.subject.text, said.object
    new = reader.relative(object.head) if object.text == object.head else reader.noun(object)
    denied = {
        reader.relative(one.object.head)
        for one in reader.seen.statements
        if one.negated and one.subject == said.subject
    }
    for topic, values in reader.known.items() if said.verb == "be" and not said.negated else ():
        if TOPICS[topic].kind != "people" or topic == new or not any(same(name, value) for value in values):
            continue
        verb = reader.verb(said)
        more = said.phrases or said.when or is_limited(reader, said) or (verb and reader.tree.children(verb, "advcl"))
        alone = object.text == object.head and not more  # not "Rex is a cat at heart"
        plain = alone and new and TOPICS[new].type == TOPICS[topic].type == "Animal"
        if topic in denied or plain:
            yield topic, new, name


def is_partial(reader: Utterance, said: nlp.Statement) -> bool:
    """Return whether a negation denies only a part: *I'm not just a nurse*, *I don't row because it's cheap*."""
    lasting = {"more", "longer", "anymore"} & reader.words
    reason = "because" in reader.words and not lasting and said.verb != "be"
    return said.negated and (reason or _PARTLY.search(reader.tree.text) is not None)


def denied_by(reader: Utterance, said: nlp.Statement, phrase: Phrase | None) -> bool:
    """Return whether a denial holds for good: *I don't play chess any more*, but not *I don't play chess today*."""
    others = [one.text for one in said.phrases if phrase and one != phrase and one.text not in said.when]
    return not (others or is_limited(reader, said) or {"did", "didn't"} & reader.words)


def is_limited(reader: Utterance, said: nlp.Statement) -> bool:
    """Return whether an adverb or a time limits a statement: *I don't live alone*, *I left early*, *not today*."""
    verb = reader.verb(said)
    kinds = ("advmod", "prt") if said.verb == "be" else ("advmod", "prt", "acomp")
    adverbs = {word.low for word in reader.tree.children(verb, *kinds)} if verb else set[str]()
    particles = {
        *predicate_of(said).split(),
        *WORDS["lasting"],
        *(one.lower() for had in reader.known.values() for one in had),
    }
    return bool(adverbs - particles or (NOW - {"now"}) & set(said.when.lower().split()))


def is_brief(said: nlp.Statement) -> bool:
    """Return whether a statement holds only for a while: *I quit Bosch for the day*."""
    return any(one.preposition == "for" and one.head in WORDS["leisure"] for one in said.phrases)


def may_correct(seen: nlp.Analysis, topic: str) -> bool:
    """Return whether an utterance may correct a fact just mentioned: its only verbs are *say*, *mean* and the like."""
    opposed = {text for one in seen.contrasts for text in (one.right.text, one.wrong.text)}  # the tagger may see verbs
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
    """Return the value that the user repeats more clearly, just after the agent understood `latest`: *Lora with an L*."""
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
