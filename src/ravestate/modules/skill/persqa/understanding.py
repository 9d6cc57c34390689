"""The meaning of an utterance for the conversation about the user."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

from ravestate.modules import nlp

from . import kinds
from .answers import answer, correction, may_stand_alone, spelled_out
from .reading import Reader
from .relations import relations
from .talk import CONFIRM, FORGET, Talk
from .told import Told, answers_in, told_in
from .topics import NAME, TOPICS, Fact, is_topic
from .wording import among

EVERYTHING = "everything"
"""Stands for all topics."""

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
    "asked_told",  # about a free statement of before
    "vouched",  # the answer by which somebody shows that they are who they say
    "identified",  # it's me, perhaps with a name
    "mistaken",  # they are not the person that the agent takes them for
    "strike",  # forget some facts
    "forget",  # forget everything
    "forget_yes",
    "forget_no",
]


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
        free: Free statements that they make, ask for, or want forgotten.
    """

    kind: Kind
    facts: tuple[Fact, ...] = ()
    topic: str = ""
    leave: bool = False
    aloud: bool = True
    free: tuple[Told, ...] = ()


def understand(
    seen: nlp.Analysis,
    talk: Talk,
    known: Mapping[str, tuple[str, ...]],
    now: float,
    within: float,
    told: Iterable[Told] = (),
) -> Meaning:
    """Return the meaning of an utterance at `now`; a question waits `within` seconds for its answer."""
    pending = talk.pending(now, within)
    topic = pending.topic if pending else ""
    reader = Reader(seen, talk.doubt if topic == CONFIRM else topic if is_topic(topic) else "")
    acts = _acts(seen)
    leave = "farewell" in seen.acts
    wish = _forgetting(seen, reader, known, told)
    if wish is not None and wish.kind == "forget":
        return wish
    if topic == FORGET:
        fresh = pending is not None and pending.fresh  # a yes to something else must not delete anything
        return _of_forgetting(seen, leave) if fresh else Meaning("nothing", leave=leave)
    if wish is not None:
        return wish
    if pending is not None and is_topic(topic) and not pending.turns and "refuse" in acts:
        return Meaning("declined", topic=topic)
    if topic == CONFIRM and (vouched := _vouched(seen, reader, talk.doubt, acts)):
        return vouched
    asks = seen.question is not None
    if (asks or "ask_everything" in acts) and (inquiry := _inquiry(seen, reader, acts, known, told)):
        return inquiry
    facts = [fact for fact in reader.facts(known) if not fact.gone or _matters(fact, known, topic)]
    free = tuple(told_in(reader))
    aside = leave or asks
    if facts or free:
        return Meaning("told", tuple(facts), topic, leave, aloud=bool(facts) and not aside, free=free)
    text = spelled_out(seen.tree.text).strip()
    if talk.correctable not in ("", NAME) and seen.yesno.no and (put_right := _put_right(seen, text, talk, pending)):
        return put_right
    if identity := _identity(seen, known):
        return identity
    if aside:
        before = _before_question(text) if asks and topic else ""
        side = answer(before, topic, seen) if before else []
        if asks and not side and "ask_own" in acts and _of_user(seen):
            return Meaning("asked", (Fact("", ()),))
        return Meaning("told" if side else "nothing", tuple(side), topic, leave, aloud=False)
    if (relative := reader.without_name()) and not known.get(relative):
        return Meaning("mentioned", topic=relative)
    if talk.correctable and (put_right := _put_right(seen, text, talk, pending)):
        return put_right
    if pending is None or not is_topic(topic):
        return Meaning("nothing")
    return _of_answer(seen, text, topic, acts, fresh=pending.fresh)


def _put_right(seen: nlp.Analysis, text: str, talk: Talk, pending: object) -> Meaning | None:
    """Return the correction of the fact that the user told last."""
    facts = correction(text, talk.correctable, talk.latest, seen, explicit=pending is not None)
    return Meaning("corrected", tuple(facts), talk.correctable) if facts else None


def _of_answer(seen: nlp.Analysis, text: str, topic: str, acts: set[str], *, fresh: bool) -> Meaning:
    """Return the meaning of words that may answer the open question."""
    if fresh and "nothing" in acts:
        return Meaning("none" if topic != NAME else "declined", topic=topic)
    answered = answer(text, topic, seen) or (
        correction(text, topic, (), seen) if seen.yesno.no else []
    )  # no, from Bremen
    if answered and may_stand_alone(seen) and not {"thanks", "greeting", "acknowledgement"} & set(seen.acts):
        return Meaning("told", tuple(answered), topic)
    if not fresh:
        return Meaning("nothing")
    return Meaning(_of_yesno(seen.yesno, topic, text), topic=topic)


def _acts(seen: nlp.Analysis) -> set[str]:
    """Return the acts of the sentences, by the classes of `acts.yaml`."""
    return {match.name for match in kinds.acts().match_all(seen.sentences) if match is not None}


# --------------------------------------------------------------------------------------------- forgetting


def _forgetting(
    seen: nlp.Analysis, reader: Reader, known: Mapping[str, tuple[str, ...]], told: Iterable[Told]
) -> Meaning | None:
    """Return the wish to forget; None if the utterance has none."""
    table = relations()
    for said in seen.statements:
        if said.verb not in table.words["forgetting"] or not _is_wish(seen, said):
            continue
        object = said.object
        if (
            object.person == "I"
            or (object.head or object.text.lower()) in table.words["everything"]
            or object.text.lower().endswith(" data")
        ):
            about_me = object.person == "I" or re.search(r"\b(?:me|my|i)\b", seen.text, re.IGNORECASE)
            return Meaning("forget") if about_me else None
        value = object.text
        facts = [Fact(topic, (value,), gone=True) for topic, values in known.items() if value and among(value, values)]
        facts = facts or [Fact(topic, (), gone=True) for topic in filter(None, [reader.noun(object)])]
        facts = facts or [
            Fact(fact.topic, fact.values, gone=True) for fact in reader.facts() or filter(None, [reader.asks()])
        ]
        names = {value or "-", *(name for fact in facts for name in fact.values or known.get(fact.topic, ()))}
        said_again = {one.key for one in told_in(reader)}
        free = tuple(one for one in told if {one.subject, one.object} & names or one.key in said_again)
        if facts or free:
            return Meaning("strike", tuple(facts), free=free)
        if object.of("I") or any(other.subject.person == "I" for other in seen.statements):
            return Meaning("strike")
    match = seen.act("forget_me")
    verbs = {said.verb for said in seen.statements}
    return Meaning("forget") if match and match.score > 0.7 and not verbs & table.words["forgetting"] else None


def _is_wish(seen: nlp.Analysis, said: nlp.Statement) -> bool:
    """Return whether the user asks the agent to do this: *forget me*, *can you forget me*, *I want you to forget me*."""
    if said.negated or said.hearsay or said.conditional or said.subject.person != "you":
        return False
    words = [word.low for word in seen.tree.words]
    return said.request or "want" in words or bool({"can", "could", "would", "please"} & set(words[:3]))


def _of_forgetting(seen: nlp.Analysis, leave: bool) -> Meaning:
    if seen.yesno.yes:
        return Meaning("forget_yes", leave=leave)
    if seen.yesno.no or seen.yesno.unsure:
        return Meaning("forget_no", leave=leave)
    return Meaning("nothing", leave=leave)


# ----------------------------------------------------------------------------------------------- identity


def _vouched(seen: nlp.Analysis, reader: Reader, topic: str, acts: set[str]) -> Meaning | None:
    """Return the answer by which the user shows who they are; one without facts if they cannot or will not."""
    told = [fact for fact in reader.facts() if fact.topic == topic and not fact.gone]
    told = told or (
        answer(spelled_out(seen.tree.text), topic, seen) if seen.question is None and may_stand_alone(seen) else []
    )
    if told or seen.yesno.no or seen.yesno.unsure or {"refuse", "nothing"} & acts:
        return Meaning("vouched", tuple(told[:1]))
    return None


def _identity(seen: nlp.Analysis, known: Mapping[str, tuple[str, ...]]) -> Meaning | None:
    """Return that the user says who they are, or who they are not."""
    if "deny_identity" in seen.acts and known.get(NAME):
        return Meaning("mistaken")
    match = seen.act("identify")
    other = any(
        said.subject.of("I") or (said.subject.person == "I" and isinstance(said.triple.object, nlp.QuestionWord))
        for said in seen.statements
    )  # my name is..., who am I talking to
    if match is None or other:
        return None
    name = Reader(seen).remaining_name()
    return Meaning("identified", (Fact(NAME, (name,)),) if name else ())


# ---------------------------------------------------------------------------------------------- questions


def _inquiry(
    seen: nlp.Analysis, reader: Reader, acts: set[str], known: Mapping[str, tuple[str, ...]], told: Iterable[Told]
) -> Meaning | None:
    """Return a question about the user, or about what they told."""
    if "ask_everything" in acts:
        return Meaning("asked", (Fact(EVERYTHING, ()),))
    if asked := reader.asks():
        return Meaning("asked", (asked,))
    wished = any(said.plan for said in seen.statements)  # do you want to know my name
    for said in seen.statements:
        about = said.question and not wished and said.verb in ("be", *relations().words["knowing"])
        if about and (topic := reader.noun(said.object) or _topic_of(said, known)):
            return Meaning("asked", (Fact(topic, ()),))
    if "ask_name" in acts and not wished:
        return Meaning("asked", (Fact(NAME, ()),))
    found = answers_in(reader, told, known)
    return Meaning("asked_told", free=tuple(found)) if found else None


def _topic_of(said: nlp.Statement, known: Mapping[str, tuple[str, ...]]) -> str:
    """Return the topic of a person whom a question names: *who is Emma*."""
    named = [phrase.text for phrase in (said.subject, said.object, *said.phrases) if phrase.text]
    people = ((topic, value) for topic, values in known.items() if TOPICS[topic].nouns for value in values)
    return next((topic for topic, value in people if among(value, named)), "")


def _of_user(seen: nlp.Analysis) -> bool:
    """Return whether a question is about the user or their own."""
    return any(said.question and (said.subject.person == "I" or said.subject.of("I")) for said in seen.statements)


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
        return any(among(value, known.get(fact.topic, ())) for value in fact.values)
    return fact.topic == topic or TOPICS[fact.topic].kind != "place" or bool(known.get(fact.topic))


def _before_question(text: str) -> str:
    """Return the words before a question in the same breath: *hannover* in *hannover, and you?*."""
    parts = _TURNED.split(text.rstrip(" ?"), maxsplit=1)
    return parts[0].strip() if len(parts) > 1 else ""


_TURNED = re.compile(
    r"[.;!…\n]+|,?\s(?=(?:and|what about|how about) (?:you|yours)\b|(?:what's|what is|where|who|what) (?:yours|about you|are you)\b)",
    re.IGNORECASE,
)
