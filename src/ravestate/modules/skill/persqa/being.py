"""Statements of the form *I am ...*: an age, an occupation, studies, or a name."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravestate.language.lexicon import loaded_lexicon
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase

from .kinds import likeness
from .link import Link
from .topics import NAME, NATIONS, NATIONS_BESIDE, SAYS, TOPICS, WORDS
from .utterance import Utterance
from .values import number_in


def being_in(reader: Utterance, said: nlp.Statement) -> Iterator[Link]:
    """Yield the links of *I am ...*: an age, an occupation, studies, or a name."""
    object, text = said.object, said.object.text
    years = re.fullmatch(r"([\w -]+?)(?: (?:years?|yrs?)(?: (?:old|young|of age))?| old)?", text.lower())
    whole = not object.preposition and reader.words.isdisjoint({"nearly", "almost", "feel", "felt"})
    whole = whole and all(
        one.head != "year" and (one.preposition not in ("on", "at") or one.text in said.when) for one in said.phrases
    )  # not "for six years", "on the inside"
    own = said.subject.text.lower() == "i" or (years and years[0] != years[1])  # not "we're three"
    if years and whole and own and (number := number_in(years[1])):
        yield Link("age", object, value=number)
    elif object.owner is not None and (found := SAYS.get(f"be {object.head} of")):
        yield Link(found[0], object.owner)
    elif (country := _country(text, reader.tree.text)) and not object.preposition:
        yield Link("origin", object, value=country)
    elif _is_nationality(reader, object):
        return  # the country is not named: "I'm Kurdish"
    elif object.head in WORDS["terms"] and " of " in text:  # "I'm in my second year of law"
        yield Link("subject", object, sure=False, value=text.partition(" of ")[2])
    elif object.preposition in ("at", "in") and object.head in TOPICS["university"].nouns:
        high = object.head != "school"  # a school in a city is no university
        places = (phrase for phrase in said.phrases if high and phrase.preposition == "in" and phrase.names)
        yield Link("university", object if object.names or object.owner else next(places, object))
    elif object.preposition in ("at", "with") and (reader.known.get("employer") or reader.asked == "employer"):
        yield Link("employer", object, sure=False)
    elif (found := re.fullmatch(rf"(?:\w+ )?(?:{'|'.join(WORDS['keen'])}) (\w+?)er", text.lower())) and _is_word(
        f"{found[1]}ing"
    ):
        yield Link("hobby", object, value=f"{found[1]}ing")  # "I'm a keen gardener"
    elif object.head == "student":
        yield Link("occupation", object, value="student")
        yield Link("subject", object.owner or object, sure=False, value="" if object.owner else text.rpartition(" ")[0])
        yield from (Link("university", phrase) for phrase in said.phrases if phrase.preposition == "at")
        for phrase in said.phrases:
            if phrase.preposition == "from":  # "a student from Lyon, a student from Leiden University"
                school = any(word.lower() in TOPICS["university"].nouns for word in phrase.text.split())
                yield Link("university" if school else "origin", phrase)
    elif not object.preposition and ((object.names and not object.head) or _is_capital(reader, object)):
        yield Link(NAME, object, sure=reader.asked == NAME or _is_capital(reader, object))
        yield from beside_name(reader, said)
    elif text and not object.preposition and not object.of("I") and object.head not in ("old", "half", "young"):
        several = any(word.lemma == object.head and word.tag == "NNS" for word in reader.tree.words)
        if several and said.subject.text.lower() == "i":
            return  # "I'm all ears"
        bare = len(text.split()) == 1 and not re.match("(?:an?|the) ", reader.written(object))
        if not bare or reader.asked == "occupation" or likeness(text, "work") > 0.3:  # "I'm noor"
            yield Link("occupation", object, sure=reader.asked == "occupation")
        yield Link(NAME, object, sure=False)
        if " of " in text and object.owner is not None and likeness(text.partition(" of ")[0], "work") > 0.2:
            yield Link("occupation", object, value=text.partition(" of ")[0])  # "I'm the head cook of a school"
        places = (phrase for phrase in said.phrases if phrase.preposition in ("at", "for", "with"))
        yield from (Link("employer", phrase, sure=False) for phrase in places)


def _is_word(word: str) -> bool:
    """Return whether the lexicon has a word: *gardening*, but not *astronoming*."""
    lexicon = loaded_lexicon()
    return lexicon is None or lexicon.count(word) > 0


def _country(text: str, whole: str) -> str:
    """Return the country in the name of its people; empty if there is none: *Denmark*, for *Danish*.

    The parser may part *South* from *Korean*, so the utterance as a `whole` counts for words of several parts.
    """
    words = " ".join(word for word in re.split(r"[\s-]", text.lower()) if word not in NATIONS_BESIDE)
    own = r"\b(?:am|'m|im|a|an|half|originally) "
    longer = (
        name for name in NATIONS if name.endswith(f" {words}") and re.search(f"{own}{name}\\b", whole, re.IGNORECASE)
    )
    return NATIONS.get(next(longer, words)) or NATIONS.get(words.removesuffix("s"), "")


def _is_nationality(reader: Utterance, phrase: Phrase) -> bool:
    labels = {entity.label for entity in reader.seen.entities if entity.text == phrase.text}
    return "NORP" in labels and likeness(phrase.text, "trait") < 0.2  # not a religion


def beside_name(reader: Utterance, said: nlp.Statement) -> Iterator[Link]:
    """Yield the age and the origin after the user's name: *I'm Ada, 36, from Rome*."""
    ages = (word for word in reader.tree.words if word.dep == "appos" and word.pos == "NUM")
    yield from (Link("age", said.object, value=word.text) for word in ages)
    yield from (Link("origin", phrase) for phrase in said.phrases if phrase.preposition == "from")


def _is_capital(reader: Utterance, phrase: Phrase) -> bool:
    """Return whether words begin with a capital as a name does: *I am Anneke*, but not *I am Greek*, *I'm a Leo*."""
    found = re.search(rf"(\w+) {re.escape(phrase.text)}(?!\w)", reader.seen.text)
    labels = {entity.label for entity in reader.seen.entities if phrase.text in entity.text} - {"PERSON", "ORG"}
    return bool(found and phrase.text.istitle() and not labels and found[1].lower() not in WORDS["determiners"])
