"""Statements of the user about themselves: *I live in Hannover and work as a baker*."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

from .patterns import wanted
from .phrase import values
from .statement_patterns import ADVERBS, AM, GONE, HAVING, STATED
from .topics import NAME, TOPICS, Fact, favourite
from .words import NO_STUDENT, NOT_DONE, OCCUPATIONS, STATES, VERBS

_I_AM = re.compile(rf"(?<![\w'])(?:{AM}|this is )(?=(?P<wanted>.+))", re.IGNORECASE)
_A = re.compile(r"(?:an? )(.+)", re.IGNORECASE)
_NAMED = re.compile(r"\b(?:called|named|names?)\b", re.IGNORECASE)
_STUDENT = re.compile(r"(?:an? )?((?!an? )(?:[\w-]+ ){1,3}?)student\b", re.IGNORECASE)
_SPEAKER = re.compile(r"(?<![\w'])(?:i|i'm|im|i've|my (?:\w+ )?name)(?![\w'])", re.IGNORECASE)
_JOINED = re.compile(
    rf"(?<=\w )(and|but) (?={ADVERBS}(?:live|work|study|come from|moved to|grew up|was born|am|belong to|joined)\b)",
    re.IGNORECASE,
)
"""A second verb with the same subject: *I live in Ulm and work as a baker*."""
_UNREAL = re.compile(
    r"\b(?:if|when|whenever|wish|unless|until|once|suppose|imagine|pretend|say|says|said|whether|where|before|while|after|"
    r"dreamt|dreamed|thought|think|thinks|hope|because)(?: that)? $",
    re.IGNORECASE,
)
"""Words before a statement that make it hypothetical."""


def statements(text: str, *, persons: Collection[str] = (), asked: str = "") -> list[Fact]:
    """Return the facts that a text states, one for each topic.

    Args:
        text: The result of `plain`.
        persons: The persons' names in it.
        asked: The topic of the open question, or an empty string.

    Example:
        >>> statements("My name is Ada and I live in new york.")
        [Fact(topic='name', values=('Ada',), gone=False), Fact(topic='home', values=('New York',), gone=False)]
    """
    if speaker := _SPEAKER.search(text):
        text = text[: speaker.end()] + _JOINED.sub(r"\1 i ", text[speaker.end() :])
    found: dict[str, Fact] = {}
    for fact in (*_stated(text, persons, asked), *_denied(text), *_being(text, persons, asked)):
        known = found.get(fact.topic)
        if known is None or (known.gone and not fact.gone):  # I don't live in Ulm, I live in Bremen
            found[fact.topic] = fact
    if asked == "home" and "origin" in found and "home" not in found:  # the user says that they are from there
        origin = found.pop("origin")
        found["home"] = Fact("home", origin.values, origin.gone)
    return list(found.values())


def _stated(text: str, persons: Collection[str], asked: str) -> Iterator[Fact]:
    for name, pattern in STATED:
        topic, _, form = name.partition(":")
        for match in pattern.finditer(text):
            if _UNREAL.search(text[: match.start()]):
                continue
            rest = wanted(match)
            if topic == "favourite":
                topic = favourite(match["favourite"])
            said = values(gerund(rest) if form else rest, TOPICS[topic])
            if topic == "liking":
                yield from likings(said)
                break
            if TOPICS[topic].kind == "people" and topic != asked and not _NAMED.search(match[0]):
                said = said if any(_is_person(value, text, persons) for value in said) else ()
            if topic == "occupation" and not form and rest.lower().startswith("student"):
                said = ("student",)
            if said:
                yield Fact(topic, said)
                break


def _denied(text: str) -> Iterator[Fact]:
    for name, pattern in GONE:
        topic, _, form = name.partition(":")
        match = pattern.search(text)
        if match is None or _UNREAL.search(text[: match.start()]):
            continue
        rest = wanted(match)
        said = values(gerund(rest) if form else rest, TOPICS[topic])
        if topic == "liking":
            yield from (Fact(fact.topic, fact.values, gone=True) for fact in likings(said))
        elif said or not rest:
            yield Fact(topic, said, gone=True)


def relative_in(text: str) -> str:
    """Return the relative whom the user mentions without a name, as a topic; empty if there is none.

    Example:
        >>> relative_in("I have two brothers")
        'brother'
    """
    found = ((topic, pattern.search(text)) for topic, pattern in HAVING)
    return next((topic for topic, at in found if at and not _UNREAL.search(text[: at.start()])), "")


def likings(said: Iterable[str]) -> list[Fact]:
    """Return activities as hobbies, and everything else as likings.

    Example:
        >>> likings(["rock climbing", "pizza"])
        [Fact(topic='hobby', values=('rock climbing',), gone=False), Fact(topic='liking', values=('pizza',), gone=False)]
    """
    by: dict[str, tuple[str, ...]] = {}
    for value in said:
        done = any(word.endswith("ing") and len(word) > 4 and word not in NOT_DONE for word in value.lower().split())
        topic = "hobby" if done else "liking"
        by[topic] = (*by.get(topic, ()), value)
    return [Fact(topic, by[topic]) for topic in ("hobby", "liking") if topic in by]


def _being(text: str, persons: Collection[str], asked: str) -> Iterator[Fact]:
    """Yield the facts in *I am ...*: a name, or an occupation."""
    for match in _I_AM.finditer(text):
        if _UNREAL.search(text[: match.start()]):
            continue
        rest = wanted(match)
        student = _STUDENT.match(rest)
        subject = values(student[1], TOPICS["subject"]) if student else ()
        if student and subject and not NO_STUDENT & set(student[1].lower().split()):
            yield Fact("occupation", ("student",))
            yield Fact("subject", subject)
            continue
        if a := _A.match(rest):
            said = values(a[1], TOPICS["occupation"])
            if said and (asked == "occupation" or _heads(said[0])):
                yield from worker(a[1])
        elif asked == "occupation" or re.match(r"(?:retired|self-employed)\b", rest, re.IGNORECASE):
            yield from worker(rest)
        elif (said := values(rest, TOPICS[NAME])) and (asked == NAME or _is_person(said[0], text, persons)):
            yield Fact(NAME, said)


def worker(text: str) -> list[Fact]:
    """Return the facts in *baker at Siemens*: an occupation and an employer."""
    said = values(text, TOPICS["occupation"])
    if not said:
        return []
    where = re.match(r"[^,.;!?]*? (?:at|for) (.+)", text, re.IGNORECASE)
    place = "university" if said == ("student",) else "employer"
    there = values(where[1], TOPICS[place]) if where else ()
    return [Fact("occupation", said), *([Fact(place, there)] if there else [])]


def _heads(value: str) -> bool:
    """Return whether the head noun is an occupation: *head* in *head of school*, *teacher* in *school teacher*."""
    return value.lower().split(" of ")[0].split()[-1] in OCCUPATIONS


def _is_person(value: str, text: str, persons: Collection[str]) -> bool:
    """Return whether a value is a person's name."""
    low = value.lower()
    return low.split()[0] not in STATES and any(low == person.lower() for person in persons)


_DOUBLED = frozenset(["swim", "run", "jog", "knit", "program", "blog"])
_KEPT = frozenset(["ski", "do", "go"])


def gerund(text: str) -> str:
    """Return a verb phrase as a hobby.

    Example:
        >>> gerund("read books and swim")
        'reading books and swimming'
    """
    text = re.sub(r"\bgo (?=[a-z]{2,}ing\b)", "", text)  # go swimming
    return re.sub(
        r"(^|\b(?:and|or) |, ?)(to )?(\w+)",
        lambda found: found[1] + _gerund(found[3], sure=bool(found[2])),
        text,
    )


def _gerund(verb: str, *, sure: bool) -> str:
    """Return the gerund of a verb; with `sure` the word is known to be a verb."""
    low = verb.lower()
    if low.endswith("ing") or not (sure or low in VERBS):
        return verb
    if low in _DOUBLED:
        return low + low[-1] + "ing"
    return (low[:-1] if low.endswith("e") and low not in _KEPT else low) + "ing"
