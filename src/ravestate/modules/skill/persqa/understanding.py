"""The meaning of an utterance for the conversation about the user.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from ravestate.language.feelings import SORROWS
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.answer import is_only_yes
from ravestate.modules.meta.nlp.introduction import introductions_in

from . import kinds
from .answers import spelled_out, without_opening
from .changes import is_similar
from .contrast import Correction, corrected_in, denied_in
from .reading import Reader
from .recollection import asks_for_words, asks_to_repeat
from .talk import CONFIRM, FORGET, Talk
from .told import Told, is_about, recalled, told_in
from .topics import NAME, NOUNS, TOPICS, WORDS, Fact, is_topic, touched_by
from .wording import Facts, alike, among, same

EVERYTHING = "everything"
"""The value of `Fact.topic` that stands for all topics."""

SURELY = 0.7
"""The minimum confidence that a sentence says who the user is, if the utterance has several sentences."""
BRIEF = 4
"""The maximum number of words of a mere yes. It is also the maximum number of words of an utterance after which the agent
may ask about something else."""

Kind = Literal[
    "nothing",  # nothing that concerns persqa
    "told",
    "corrected",
    "declined",  # the user would rather not say
    "none",  # the user has none, for example no hobby
    "unsure",
    "which",  # the user only said yes, so the agent must ask for the value
    "mentioned",  # the user mentioned a relative without a name
    "asked",  # the user asked about themselves
    "asked_told",  # the user asked about something that they said earlier, and that no topic covers
    "asked_words",  # like `asked_told`, but perhaps the user's own words have the answer
    "vouched",  # the user answered the question that tests who they are, or refused to
    "identified",  # the user said "it's me", perhaps with a name
    "mistaken",  # the user is not the person that the agent takes them for
    "strike",  # the agent should forget some facts
    "forget",  # the agent should forget everything
    "forget_yes",
    "forget_no",
]


@dataclass(frozen=True, slots=True)
class Meaning:
    """The meaning of an utterance."""

    kind: Kind
    facts: tuple[Fact, ...] = ()
    topic: str = ""
    """The topic of the agent's question that the user answers."""
    leave: bool = False
    aloud: bool = True
    """Whether persqa replies. If not, another rule replies, and persqa learns the facts silently.

    Another rule replies if the user also asks something, says goodbye, is sad, or wants a sum. The same is true of
    denials that change no known fact.
    """
    free: tuple[Told, ...] = ()
    """*Free statements*, which no topic covers: those that the user makes, asks about, or wants forgotten."""
    gone: tuple[Told, ...] = ()
    """Free statements that the user denies or corrects."""
    touched: frozenset[str] = frozenset()
    """The topics for which the user uses typical words, such as *office* for the occupation."""
    person: str = ""
    """The topic of the relative whom the user mentions."""
    another: bool = False
    """Whether the name that the user tells is another person's, and not the right spelling of the known name."""
    said: tuple[Told, ...] = ()
    words: tuple[str, ...] = ()
    """The sentences without a question mark; empty if the utterance asks something. If the kind is ``asked_words``: the sentence that answers the question."""
    moved: bool = False
    """Whether the user jokes, praises, plays, or shows a feeling that is not calm (`_CALM`)."""
    busy: bool = False
    """Whether the user asks, or tells at some length, something that is no fact about them."""


def understand(
    seen: nlp.Analysis, talk: Talk, known: Facts, now: float, within: float, told: Iterable[Told] = ()
) -> Meaning:
    """Return the meaning of an utterance at `now`. The agent's question waits `within` seconds for an answer."""
    hearing = _Hearing(seen, talk, known, now, within, tuple(told))
    touched = touched_by([word.lemma for word in seen.tree.words])
    relatives = [phrase.head for said in seen.statements for phrase in (said.subject, said.object) if phrase.of("I")]
    person = next((topic for topic in map(hearing.reader.relative, relatives) if topic), "")
    said = told_in(hearing.reader, talk.said)[1]
    words = tuple(one for one in seen.sentences if not one.rstrip().endswith("?")) if seen.question is None else ()
    meaning = hearing.meaning()
    asked = [understand(one, talk, known, now, within, hearing.told) for one in seen.questions]
    if asked and all(
        one.kind.startswith("asked") and (one.facts or one.free) for one in asked
    ):  # "what is my name and where do I live?"
        facts = (fact for one in asked for fact in one.facts)
        meaning = replace(asked[0], kind="asked", facts=tuple(facts), free=tuple(t for one in asked for t in one.free))
    noted = {"touched": touched, "person": person, "said": tuple(said), "words": words, "moved": hearing.moved}
    if meaning.kind in ("told", "corrected", "nothing") and (denied := denied_in(said, (*hearing.told, *talk.said))):
        kind = "told" if meaning.kind == "nothing" else meaning.kind
        meaning = replace(meaning, kind=kind, gone=(*meaning.gone, *denied))
    another = any(map(hearing.is_another, (fact for fact in meaning.facts if fact.topic == NAME)))
    busy = not meaning.facts and (seen.question is not None or len(seen.text.split()) > BRIEF)
    return replace(meaning, busy=busy, another=another, **noted)


class _Hearing:
    def __init__(
        self, seen: nlp.Analysis, talk: Talk, known: Facts, now: float, within: float, told: tuple[Told, ...]
    ) -> None:
        self.seen, self.talk, self.known, self.told = seen, talk, known, told
        self.pending = talk.pending(now, within)
        self.fresh = self.pending is not None and self.pending.fresh
        self.topic = self.pending.topic if self.pending else ""
        self.waits = is_topic(self.topic)
        asked = talk.doubt if self.topic == CONFIRM else self.topic if self.waits else ""
        self.reader = Reader(seen, asked, talk.person, known)
        self.acts = {match.name for match in kinds.acts().match_all(seen.sentences) if match is not None}
        self.text = spelled_out(seen.tree.text)
        self.sum = any(map(str.isdigit, self.text))  # "no time, 12 x 3" wants a sum, which another module answers
        self.answers = self.waits and any(tag.label == self.topic for tag in self.reader.tags)
        self.leave = "farewell" in seen.acts and not self.is_unsure("farewell")
        self.sorry = bool(SORROWS & set(seen.feelings))
        self.moved = bool(set(seen.feelings) - _CALM or {"joke", "praise", "play"} & set(seen.acts))

    def meaning(self) -> Meaning:
        seen, topic, asks = self.seen, self.topic, self.seen.question is not None
        wish = self.wish_to_forget()
        if wish is not None and (wish.kind == "forget" or topic != FORGET):
            return wish
        if topic == FORGET:
            # Deletion cannot be undone: a "yes" to something else, or one that only resembles a yes, deletes nothing.
            yes = self.fresh and not asks and is_only_yes(self.text)
            no = self.fresh and not yes and (seen.yesno.no or seen.yesno.unsure)
            if yes or no or not asks:
                kind = "forget_yes" if yes else "forget_no" if no else "nothing"
                return Meaning(kind, leave=self.leave)
            topic = ""  # "what's my name?" is no answer
        if (
            self.waits
            and self.pending
            and not self.pending.turns
            and "refuse" in self.acts
            and self.of_speakers()
            and not self.sorry
        ):
            return Meaning("declined", topic=topic, aloud=not asks and not self.sum)
        if topic == CONFIRM and (vouched := self.vouched()):
            return vouched
        stated = self.reader.facts()
        topics = {fact.topic for fact in stated if not fact.gone}
        found = recalled(self.reader, (*self.told, *self.talk.said), self.known) if asks else []
        told = asks and (not seen.advised or found or self.reader.asks() or asks_for_words(seen))
        if told or "ask_everything" in self.acts:
            inquiry = self.inquiry()
            if self.talk.words and asks_to_repeat(seen):
                return Meaning("asked_words", facts=inquiry.facts if inquiry else ())
            if inquiry and inquiry.facts[0].topic == NAME and NAME in topics:  # "my name is Ada. What is my name?"
                asks, inquiry = False, None
            if inquiry and self.is_known(inquiry.facts[0].topic):
                return inquiry
            if found:
                return Meaning("asked_told", free=tuple(found))
            if self.talk.words and asks_for_words(self.seen):
                return Meaning("asked_words", facts=inquiry.facts if inquiry else ())
            if inquiry:
                return inquiry
        told = topics
        facts = [fact for fact in stated if fact.topic in told or self.matters(fact)]
        pointed = not self.reader.words & _NAMING and all(fact.topic == NAME for fact in facts)  # "it's Leipzig"
        fixed = Correction() if asks else self.correction([v for fact in facts for v in fact.values if not pointed])
        facts = [] if fixed and pointed else facts
        if fixed and (seen.contrasts or not facts):
            return Meaning("corrected", (*facts, *fixed.facts), topic, self.leave, free=fixed.free, gone=fixed.gone)
        other = any(fact.topic == NAME and not self.is_name(fact.values) for fact in facts if not fact.gone)
        gone = any(fact.topic == NAME and fact.gone and self.is_name(fact.values) for fact in facts)
        denied = gone or self.denies_name()
        if denied and not other:  # "I'm not Ada, I'm Ida" tells another name
            return Meaning("mistaken")
        names = {value for fact in facts for value in fact.values if fact.topic == NAME}
        free = tuple(one for one in told_in(self.reader, self.talk.said)[0] if one.subject not in names)
        aside = self.leave or asks
        if not free and [fact.topic for fact in facts] == [NAME] and names and self.is_name(tuple(names)):
            return Meaning("identified", tuple(facts), topic, self.leave, aloud=not aside)
        if not free and facts and all(is_idle(fact, self.known) for fact in facts):
            other = self.otherwise(aside)
            return other if other.kind != "nothing" else Meaning("told", tuple(facts), topic, self.leave, aloud=False)
        if facts or free:
            aloud = any(
                fact.gone or fact.topic == NAME or not self.sorry for fact in facts
            )  # another module comforts a sad user
            return Meaning("told", tuple(facts), topic, self.leave, aloud=aloud and not aside, free=free)
        return self.otherwise(aside)

    def is_unsure(self, act: str) -> bool:
        """Return whether the words that were taken for an act rather answer the agent's question: *Rocky*, *Bonn*."""
        return self.answers and self.seen.acts[act].score < 0.9

    def otherwise(self, aside: bool) -> Meaning:
        """Return the meaning of an utterance that states no fact, or only makes denials that change no known fact.

        `aside` says whether the utterance asks something, or says goodbye.
        """
        seen, topic, asks = self.seen, self.topic, self.seen.question is not None
        if identity := self.identity():
            return identity
        if aside:
            mine = (said.question and (said.subject.person == "I" or said.subject.of("I")) for said in seen.statements)
            if asks and not seen.advised and "ask_own" in self.acts and any(mine):
                return Meaning("asked", (Fact(""),))
            return Meaning("nothing", topic=topic, leave=self.leave, aloud=False)
        if (relative := self.reader.without_name()) and not self.known.get(relative):
            return Meaning("mentioned", topic=relative)
        return (self.answered() if self.waits else None) or Meaning("nothing")

    def is_known(self, topic: str) -> bool:
        """Return whether the facts answer a question about a topic, at least with a fact of a related topic."""
        if topic in ("", EVERYTHING, *self.known):
            return True
        near = {*TOPICS[topic].besides, *(["origin"] if topic == "home" else [])}
        return any(self.known.get(one) for one in near)

    def is_name(self, values: tuple[str, ...]) -> bool:
        """Return whether these values are the name by which the agent knows the user."""
        return all(among(value, self.known.get(NAME, ())) for value in values)

    def is_another(self, name: Fact) -> bool:
        """Return whether a name shows that another person speaks now.

        The name comes after a farewell, or in words such as *Peter here*. A correction shows no other person: *no, I'm
        Peter*.
        """
        known, said = self.known.get(NAME, ()), " ".join(name.values)
        denied = name.gone or self.seen.contrasts or self.seen.yesno.no or "contradiction" in self.acts
        if not known or denied or alike(said, known) or without_opening(self.text):
            return False
        here = any(one.present and same(one.name, said) for one in introductions_in(self.seen.tree))
        return self.talk.parted or (here and not any(is_similar(said, one) for one in known))

    def denies_name(self) -> bool:
        """Return whether the user says that they are not the person that the agent takes them for."""
        names = self.known.get(NAME, ())
        unsaid = any(said.negated and said.verb == "say" for said in self.seen.statements)  # "I never said I was Ada"
        denials = [
            one for one in self.seen.statements if one.verb in _NAMES and (one.negated or (unsaid and one.hearsay))
        ]
        denials = [one for one in denials if one.triple.predicate != "not call" or one.subject.person != "I"]
        pairs = [
            (one, other)
            for said in denials
            for one, other in ((said.subject, said.object), (said.object, said.subject))
        ]
        return any(among(name.text, names) and other.text.lower() in _NAMED for name, other in pairs)

    def of_speakers(self) -> bool:
        """Return whether the utterance is about the user and the agent, not about others."""
        others = (said.subject for said in self.seen.statements if said.subject.person == "other")
        return all(other.text.lower() in ("", "it", "that", "this", "none") for other in others)

    def correction(self, read: Sequence[str]) -> Correction:
        """Return the correction of a known fact or of a free statement.

        A value in `read` is no correction, because the utterance states it as a fact anyway.
        """
        told = tuple({one.key: one for one in (*self.told, *self.talk.said)}.values())
        return corrected_in(self.reader, self.text, self.talk, told, read, asked=self.pending is not None)

    def answered(self) -> Meaning | None:
        """Return the meaning of words that may answer the open question."""
        seen, topic, yesno = self.seen, self.topic, self.seen.yesno
        if self.fresh and "nothing" in self.acts and not self.sorry:
            return Meaning("none" if topic != NAME else "declined", topic=topic, aloud=not self.sum)
        past = (one for one in seen.statements if one.verb == "be" and one.past and one.subject.person == "I")
        excused = not {"no", "never"} & self.reader.words and any(not one.negated for one in past)
        if not self.fresh or not yesno or excused:  # "I was away" says why the question waited, and answers nothing
            return None
        if yesno.unsure or yesno.no:
            declined = topic in (NAME, "home", "origin")
            return Meaning(
                "unsure" if yesno.unsure else "declined" if declined else "none", topic=topic, aloud=not self.sum
            )
        mere = (
            is_only_yes(self.text)
            and len(self.text.split()) <= BRIEF
            and not {"acknowledgement", "praise", "joke"} & set(seen.acts)
        )
        return Meaning("which", topic=topic) if mere else None

    def vouched(self) -> Meaning | None:
        """Return the answer to the question that tests who the user is. If they refuse, the meaning has no facts."""
        seen, topic = self.seen, self.talk.doubt
        told = [fact for fact in self.reader.facts() if fact.topic == topic and not fact.gone]
        refused = seen.yesno.no or seen.yesno.unsure or {"refuse", "nothing"} & self.acts
        return Meaning("vouched", tuple(told[:1])) if told or refused else None

    def identity(self) -> Meaning | None:
        """Return the meaning if the user says who they are, or who they are not."""
        denied = self.seen.act("deny_identity")
        kin = any(
            said.negated and said.verb == "be" and said.subject.person == "I" and said.object.owner
            for said in self.seen.statements
        )  # "I'm not Ben's mother"
        if denied and not kin and self.known.get(NAME) and (denied.score > 0.6 or not self.correction(())):
            return Meaning("mistaken")
        other = any(
            said.subject.of("I") or (said.subject.person == "I" and isinstance(said.triple.object, nlp.QuestionWord))
            for said in self.seen.statements
        )  # "my name is..., who am I talking to"
        match = self.seen.act("identify")
        if other or match is None or match.text.endswith("?"):  # "me?"
            return None
        if len(self.seen.sentences) > 1 and match.score < SURELY:  # "Pete. I'd shout his name from the kitchen."
            return None
        return Meaning("identified", leave=self.leave, aloud=not self.leave)

    def inquiry(self) -> Meaning | None:
        """Return the meaning of a question about the user, or about something that they told."""
        if self.seen.closing is not None and self.seen.closing.returned:  # "I love jazz, do you?" asks about the agent
            return None
        named = any(phrase.names for said in self.seen.statements for phrase in (said.object, *said.phrases))
        if "ask_everything" in self.acts and not named and self.of_speakers():
            phrases = (phrase for said in self.seen.statements if said.question for phrase in said.phrases)
            about = [phrase for phrase in phrases if phrase.preposition == "about"]
            if topic := next(
                (topic for one in about if (topic := self.reader.noun(one))), ""
            ):  # "did I tell you about my sister"
                return Meaning("asked", (Fact(topic),))
            others = any(phrase.of("I") and WORDS["kin"] & {phrase.head} for phrase in about)
            return Meaning("asked", (Fact("" if others else EVERYTHING),))
        wished = any(said.plan for said in self.seen.statements)  # "do you want to know my name"
        offered = wished and self.seen.question == nlp.QuestionWord.YES_NO  # "do you want to be my friend"
        if topic := self.pointed():
            return Meaning("asked", (Fact(topic),))
        if not offered and not self.of_another() and (asked := self.reader.asks()):
            return Meaning("asked", (asked,))
        for said in () if wished else self.seen.statements:
            if said.question and said.verb in ("be", *WORDS["knowing"]):
                named = [phrase.text for phrase in (said.subject, said.object, *said.phrases) if phrase.text]
                people = [topic for topic in self.known if TOPICS[topic].kind == "people"]  # "who is Emma"
                people = people if self.seen.question != nlp.QuestionWord.AMOUNT else []
                people = [topic for topic in people if any(among(name, self.known[topic]) for name in named)]
                if topic := self.reader.noun(said.object) or next(iter(people), ""):
                    return Meaning("asked", (Fact(topic),))
        if "ask_name" in self.acts and not wished:
            return Meaning("asked", (Fact(NAME),))
        return None

    def pointed(self) -> str:
        """Return the topic of *and my job?*, or the topic of the being whom the pronoun in *what was his name?* may mean.

        This being is a relative, a friend or a pet whose name the agent knows.
        """
        if found := _ELLIPSIS.match(self.text):
            topic = NOUNS.get(found[1].lower(), "")
            return topic if self.known.get(topic) else ""
        found = _WHOSE.search(self.text)
        if found is None or self.seen.question is None:
            return ""
        fit = [
            topic for topic in self.known if TOPICS[topic].kind == "people" and topic not in _OTHERS[found[1].lower()]
        ]
        return self.talk.person if self.talk.person in fit else next(reversed(fit), "")

    def of_another(self) -> bool:
        """Return whether the user asks for a fact about somebody else: *what is my aunt's job?*."""
        phrases = [phrase for said in self.seen.statements if said.question for phrase in (said.subject, said.object)]
        owners = [phrase.owner for phrase in phrases if phrase.owner is not None and not self.reader.noun(phrase.owner)]
        return any(owner.person == "other" and owner.head for owner in owners)

    def wish_to_forget(self) -> Meaning | None:
        """Return the user's wish that the agent forget something; None if there is no such wish."""
        wishes = [said for said in self.seen.statements if said.verb in WORDS["forgetting"]]
        for said in filter(self.is_wish, wishes):
            object, low = said.object, said.object.text.lower()
            if low == "it":
                continue  # "forget it" is an idiom for "never mind"
            if object.person == "I" or (object.head or low) in WORDS["everything"] or low.endswith(" data"):
                about_me = object.person == "I" or re.search(r"\b(?:me|my|i)\b", self.seen.text, re.IGNORECASE)
                return Meaning("forget") if about_me else None
            facts = [Fact(topic, (object.text,)) for topic in self.known if low and among(low, self.known[topic])]
            facts = facts or [Fact(topic) for topic in [self.reader.noun(object)] if topic]
            facts = facts or self.reader.facts() or [fact for fact in [self.reader.asks()] if fact]
            names = {object.text or "-", *(name for f in facts for name in f.values or self.known.get(f.topic, ()))}
            again = {one.key for one in told_in(self.reader)[0]}
            mine = object.of("I")
            free = tuple(
                one
                for one in (*self.told, *self.talk.said)
                if {one.subject, one.object} & names or one.key in again or (mine and is_about(one, object.text))
            )
            if facts or free or mine or any(one.subject.person == "I" for one in self.seen.statements):
                return Meaning("strike", tuple(facts), free=free)
        match = self.seen.act("forget_me")
        return Meaning("forget") if match and match.score > 0.7 and not wishes else None

    def is_wish(self, said: nlp.Statement) -> bool:
        """Return whether the user asks the agent to do something: *forget me*, *can you forget me*."""
        if said.negated or said.hearsay or said.conditional or said.subject.person != "you":
            return False
        words = [word.low for word in self.seen.tree.words]
        return said.request or "want" in words or bool({"can", "could", "would", "please"} & set(words[:3]))

    def matters(self, fact: Fact) -> bool:
        """Return whether to note a denial. A denial of single values (*I don't play chess*) always counts.

        A denial of a whole topic (*I have no hobby*) does not count for the name. It does not count either for a place
        that is neither asked for nor known.
        """
        if fact.values or fact.topic == NAME:
            return bool(fact.values)
        return fact.topic == self.topic or TOPICS[fact.topic].kind != "place" or bool(self.known.get(fact.topic))


def is_idle(fact: Fact, known: Facts) -> bool:
    """Return whether a denial changes no known fact: *I'm not from Spain*, if the agent does not think so."""
    return fact.gone and bool(fact.values) and not any(among(one, known.get(fact.topic, ())) for one in fact.values)


_ELLIPSIS = re.compile(r"\W*(?:(?:and|so|but|ok|what about|how about)\W+)*my (\w+)\W*\?\W*$", re.IGNORECASE)
_WHOSE = re.compile(r"\b(his|her|its) name\b", re.IGNORECASE)
_FEMALE, _MALE = ("mother", "sister", "wife", "daughter"), ("father", "brother", "husband", "son")
_OTHERS = {"his": _FEMALE, "her": _MALE, "its": (*_FEMALE, *_MALE, "friend", "partner", "child")}
"""A pronoun → topics of people whom it cannot mean."""
_NAMING = frozenset(["i", "me", "name", "call", "called"])
"""Words that introduce the user's name. An utterance without them, such as *it's Leipzig*, may be about something else."""
_CALM = frozenset(["astonishing", "boredom", "compliment", "insult"])
"""Feelings that do not stop the agent from asking its next question."""
_NAMES = frozenset(["be", "call", "name"])
_NAMED = frozenset(["i", "me", "my name", "it", "this", "that", "you", "they"])
"""Words on the other side of a denied name: *I am not Ada*, *Ada is not my name*, *don't call me Ada*."""
