"""The meaning of an utterance for the conversation about the user."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from ravestate.modules import nlp

from .answers import answer, correction, has_none, refuses
from .forgetting import to_forget, wants_to_be_forgotten
from .inquiries import EVERYTHING, about_oneself, inquiry, of_whom
from .phrase import plain
from .statements import relative_in, statements
from .talk import FORGET, Talk
from .topics import NAME, TOPICS, Fact
from .words import VERBS

Kind = Literal[
    "nothing",  # for persqa
    "told",
    "corrected",
    "declined",  # the user would rather not say
    "none",  # no hobby, for example
    "unsure",
    "which",  # the user said no more than yes
    "mentioned",  # a relative without a name
    "asked",  # about themselves
    "strike",  # forget some facts
    "forget",  # forget everything
    "forget_yes",
    "forget_no",
]


LEAVE = re.compile(
    r"(?:^|[.,;!?…] *|\b(?:ok|okay|well|thanks|thank you|so|and) )(?:bye+|goodbye|good ?night|farewell|cheerio|ciao|see (?:you|ya)|"
    r"take care(?! of)|have a (?:nice|good|great) (?:day|evening|night|one)|(?:i'll )?talk to you (?:later|soon)|until tomorrow|"
    r"i (?:really )?(?:have to|must|need to|gotta|got to) (?:go|leave|run))\b(?! to\b)",
    re.IGNORECASE,
)
"""A goodbye."""


@dataclass(frozen=True, slots=True)
class Heard:
    """An utterance with the results of `nlp`."""

    text: str
    yesno: nlp.YesNo = field(default_factory=nlp.YesNo)
    question: nlp.QuestionWord | None = None
    entities: tuple[nlp.Entity, ...] = ()
    tokens: tuple[str, ...] = ()
    pos: tuple[str, ...] = ()
    triples: tuple[nlp.Triple, ...] = ()


@dataclass(frozen=True, slots=True)
class Meaning:
    """The meaning of an utterance.

    Attributes:
        kind: The act of the user.
        facts: The facts that they tell, or ask for.
        topic: The topic of the question that they answer.
        leave: Whether they say goodbye.
        aloud: Whether the agent replies. Questions, goodbyes and games of the user go first: the agent silently learns
            anything else that they say.
    """

    kind: Kind
    facts: tuple[Fact, ...] = ()
    topic: str = ""
    leave: bool = False
    aloud: bool = True


def understand(heard: Heard, talk: Talk, known: Mapping[str, tuple[str, ...]], now: float, within: float) -> Meaning:
    """Return the meaning of an utterance at `now`; a question waits `within` seconds for its answer."""
    text = plain(heard.text)
    leave = LEAVE.search(text) is not None
    pending = talk.pending(now, within)
    topic = pending.topic if pending else ""
    if wants_to_be_forgotten(text):
        return Meaning("forget", leave=leave)
    if topic == FORGET:
        fresh = pending is not None and pending.fresh  # a yes to something else must not delete anything
        return _of_forgetting(heard, leave) if fresh else Meaning("nothing", leave=leave)
    if (strike := to_forget(text, known)) is not None:
        everything = any(fact.topic == EVERYTHING for fact in strike)
        return Meaning("forget" if everything else "strike", tuple(strike), leave=leave)
    if heard.question is not None:
        if asked := inquiry(text):
            return Meaning("asked", (asked,))
        if somebody := of_whom(text, known):
            return Meaning("asked", (Fact(somebody, ()),))
    told = statements(text, persons=persons_in(heard), asked=topic)
    told = [fact for fact in told if not fact.gone or _matters(fact, known, topic)]
    aside = leave or heard.question is not None
    if told:
        return Meaning("told", tuple(told), topic, leave, aloud=not aside)
    if aside:
        before = _before_question(text) if heard.question is not None and topic else ""
        side = answer(before, topic) if before else []
        if heard.question is not None and not side and about_oneself(text, heard.question, heard.triples):
            return Meaning("asked", (Fact("", ()),))
        return Meaning("told" if side else "nothing", tuple(side), topic, leave, aloud=False)
    if (relative := relative_in(text)) and not known.get(relative):
        return Meaning("mentioned", topic=relative)
    if talk.correctable:
        put_right = correction(text, talk.correctable, talk.latest, explicit=pending is not None)
        if put_right:
            return Meaning("corrected", tuple(put_right), talk.correctable)
    if pending is None:
        return Meaning("nothing")
    if not pending.turns and refuses(text):
        return Meaning("declined", topic=topic)
    if pending.fresh and has_none(text):
        return Meaning("none" if topic != NAME else "declined", topic=topic)
    answered = answer(text, topic) or (correction(text, topic, ()) if heard.yesno.no else [])  # no, from Bremen
    if answered and may_stand_alone(heard):
        return Meaning("told", tuple(answered), topic)
    if not pending.fresh:
        return Meaning("nothing")
    return Meaning(_of_yesno(heard.yesno, topic, text), topic=topic)


def _of_forgetting(heard: Heard, leave: bool) -> Meaning:
    if heard.yesno.yes:
        return Meaning("forget_yes", leave=leave)
    if heard.yesno.no or heard.yesno.unsure:
        return Meaning("forget_no", leave=leave)
    return Meaning("nothing", leave=leave)


def may_stand_alone(heard: Heard) -> bool:
    """Return whether an utterance may be a bare answer: not a sentence about others, a request, or adverbs alone."""
    if heard.yesno and not _YES_AND.match(heard.text):
        return False  # hard to say
    if heard.pos and not _TELLING & set(heard.pos):
        return False
    if len(heard.tokens) < 3:
        return True  # Bill Gates is not a sentence, although a parser may make one of it
    for triple in heard.triples:
        subject = str(triple.subject).lower()
        if subject == "you" and triple.predicate.split()[0] not in VERBS:
            return False
        if subject and subject.split()[0] not in _SPEAKER:
            return False
    return True


_YES_AND = re.compile(
    r"\W*(?:yes|yeah|yep|yup|yea|sure|of course|certainly|ok|okay|probably|maybe|perhaps|i guess|i think|i suppose|mostly|no|nope|well|"
    r"oh|actually|honestly)\b\W+\w",
    re.IGNORECASE,
)
"""A yes with an answer after it: *yes, chess*."""
_TELLING = frozenset(["NOUN", "PROPN", "VERB", "ADJ", "NUM", "X", "SYM"])
_SPEAKER = frozenset(
    ["i", "we", "my", "our", "you", "it", "that", "this", "they", "these", "those", "his", "her", "their"]
)


def _of_yesno(yesno: nlp.YesNo, topic: str, text: str) -> Kind:
    if yesno.unsure:
        return "unsure"
    if yesno.no:
        return "declined" if topic in (NAME, "home", "origin") else "none"
    if (
        yesno.yes
        and len(text.split()) <= 4
        and not re.match(r"\W*(?:fine|good|great|ok|okay|right)\b", text, re.IGNORECASE)
    ):
        return "which"
    return "nothing"


def _matters(fact: Fact, known: Mapping[str, tuple[str, ...]], topic: str) -> bool:
    """Return whether a denial matters: it denies a known fact, or says that there are none."""
    if fact.topic == NAME:
        return any(value in known.get(NAME, ()) for value in fact.values)
    if fact.values:
        low = [value.casefold() for value in known.get(fact.topic, ())]
        return any(value.casefold() in low for value in fact.values)
    return fact.topic == topic or TOPICS[fact.topic].kind != "place" or bool(known.get(fact.topic))


def _before_question(text: str) -> str:
    """Return the words before a question in the same breath: *hannover* in *hannover, and you?*."""
    parts = _TURNED.split(text.rstrip(" ?"), maxsplit=1)
    return parts[0].strip() if len(parts) > 1 else ""


_TURNED = re.compile(
    r"[.;!…\n]+|,?\s(?=(?:and|what about|how about) (?:you|yours)\b|(?:what's|what is|where|who|what) (?:yours|about you|are you)\b)",
    re.IGNORECASE,
)


def persons_in(heard: Heard) -> frozenset[str]:
    """Return the persons' names in an utterance: those that `nlp` found, and capitalised words that are nothing else."""
    plain_words = {word for word, pos in zip(heard.tokens, heard.pos, strict=False) if pos in _NO_NAMES}
    other = {word for entity in heard.entities if entity.label != "PERSON" for word in entity.text.split()}
    found = {
        entity.text
        for entity in heard.entities
        if entity.label == "PERSON" and not plain_words >= set(entity.text.split())
    }
    for match in _CAPITALS.finditer(heard.text):
        words = match[0].split()
        if not (other | plain_words) & set(words):
            found.update((match[0], words[0]))
    return frozenset(found)


_NO_NAMES = frozenset(["ADJ", "ADV", "VERB", "AUX", "PRON", "DET", "NUM"])
_CAPITALS = re.compile(r"(?<![\w'])[^\W\d_a-z][\w-]*(?: [^\W\d_a-z][\w-]+)*")
