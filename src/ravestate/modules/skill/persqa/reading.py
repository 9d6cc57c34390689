"""What an utterance tells or asks about the user and the people around them, read from its statements."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.tree import Word
from ravestate.yaml_text import load_yaml

from .kinds import likeness
from .told import Told, retold
from .topics import NAME, RELATIVES, TOPICS, Fact, favourite
from .values import gerund, is_gerund, value_of

LASTING = frozenset(["subject", "university", "birthplace", "childhood"])
"""Topics that the past tells as well: *I studied law*."""
ENDED = ("home", "occupation", "employer", "club")
"""Topics of which the past tells that they hold no longer, if they were known."""

_ANY = re.compile(r"(?:any|there$|here$)", re.IGNORECASE)
_NAMING = frozenset(["'s", "’s", "'", "s", "name", "names", "is", "are", "called", "named", ",", "who", "that"])
"""Words between a relative and their name: *my mother's name is Anna*."""
_NOUNS = frozenset(["PROPN", "NOUN", "X", "ADJ"])
_INTRODUCED = frozenset(["be called", "be named", "call", "name"])
_BE = "be"


@dataclass(frozen=True, slots=True)
class Relations:
    """The table `relations.yaml`."""

    says: Mapping[str, tuple[str, ...]]
    """Topics by predicate with preposition."""
    ends: Mapping[str, str]
    asks: Mapping[str, str]
    nouns: Mapping[str, str]
    """Topics by noun: *my job*, *my sister*."""
    words: Mapping[str, frozenset[str]]
    """The other lists."""


@cache
def relations() -> Relations:
    """Return the table."""
    file = files(__package__) / "relations.yaml"
    table: dict[str, Any] = load_yaml(file.read_text(encoding="utf-8"), str(file))

    def turned(name: str) -> dict[str, str]:
        return {phrase: topic for topic, phrases in table[name].items() for phrase in phrases}

    says: dict[str, tuple[str, ...]] = {}
    for topic, phrases in table["says"].items():
        for phrase in phrases:
            says[phrase] = (*says.get(phrase, ()), topic)
    relatives = {noun: topic.name for topic in RELATIVES for noun in topic.nouns}
    lists = {name: frozenset(words) for name, words in table.items() if isinstance(words, list)}
    return Relations(says, turned("ends"), turned("asks"), {**turned("nouns"), **relatives}, lists)


@dataclass(frozen=True, slots=True)
class Link:
    """A topic in a statement, and the phrase with its value; None if the statement names none."""

    topic: str
    phrase: Phrase | None = None
    sure: bool = True
    """Whether the words before it introduce such a value and no other: *my name is*."""
    value: str = ""
    """The value, where it is not the phrase itself."""


class Reader:
    """The facts in an utterance.

    Args:
        seen: The analysis of the utterance.
        asked: The topic of the agent's open question, or an empty string.
    """

    def __init__(self, seen: nlp.Analysis, asked: str = "") -> None:
        self.seen = seen
        self.asked = asked
        self._tree = seen.tree
        self._table = relations()

    # ------------------------------------------------------------------------------------ told, asked

    def facts(self, known: Mapping[str, tuple[str, ...]] | None = None) -> list[Fact]:
        """Return the facts that the user states, one for each topic; `known` are those of before."""
        told: dict[str, tuple[str, ...]] = {}
        gone: dict[str, tuple[str, ...]] = {}
        for said in self.seen.statements:
            if not self._asserted(said):
                continue
            if not said.past and (topic := self._ended(said)):
                gone.setdefault(topic, ())
                continue
            for link in self._links(said):
                values = self._values(link)
                if said.negated or (said.past and link.topic not in LASTING):
                    ended = said.past and not said.negated
                    if ended and (
                        link.topic not in ENDED or not values or values[0] not in (known or {}).get(link.topic, ())
                    ):
                        continue
                    if values or link.phrase is None or _ANY.match(link.phrase.text):
                        gone.setdefault(link.topic, values)
                    continue
                for value in () if said.negated else values:
                    pursued = link.topic == "liking" and is_gerund(value)
                    _add(told, "hobby" if pursued else link.topic, (value,))
        for topic, values in self._mentioned():
            if topic not in gone and values and (topic != NAME or topic not in told):
                _add(told, topic, values)
        if self.asked == "home" and "origin" in told and "home" not in told:
            told["home"] = told.pop("origin")
        facts = [Fact(topic, values) for topic, values in told.items()]
        facts += [Fact(topic, values, gone=True) for topic, values in gone.items() if topic not in told]
        return facts

    def asks(self) -> Fact | None:
        """Return the fact that the user asks for; it has values if they want them confirmed."""
        for said in self.seen.statements:
            if not self._is_asked(said) or said.conditional:
                continue
            unknown = next(
                (p for p in (said.triple.object, said.triple.subject) if isinstance(p, nlp.QuestionWord)), None
            )
            if unknown is None and self.seen.question != nlp.QuestionWord.YES_NO:
                unknown = self.seen.question
            links = list(self._links(said))
            if unknown is not None and said.subject_person == "I":
                asked = f"{_predicate(said)} {unknown.name}"
                what = self._asked_noun(said)
                heads = [f"{asked} {phrase.head}" for phrase in said.phrases]
                topic = what or next(filter(None, map(self._table.asks.get, [*heads, asked])), "")
                if topic:
                    return Fact(topic, ())
            if unknown not in (None, nlp.QuestionWord.PERSON, nlp.QuestionWord.OBJECT, nlp.QuestionWord.PLACE):
                continue
            for link in links:
                values = self._values(link) if unknown is None else ()
                if values or link.phrase is None or unknown is not None or TOPICS[link.topic].nouns:
                    return Fact(link.topic, values)
        return None

    def topics_of(self, phrase: Phrase) -> list[str]:
        """Return the topic of *my sister*, *my address*, in a list; an empty one for other phrases."""
        topic = self._noun(phrase)
        return [topic] if topic else []

    def people_asked(self) -> list[str]:
        """Return the names that a question asks about: *who is Emma*."""
        found: list[str] = []
        for said in self.seen.statements:
            if said.question and said.verb in ("be", *self._table.words["knowing"]):
                found += [phrase.text for phrase in (said.subject, said.object, *said.phrases) if phrase.text]
        return found

    def told_asked(self, told: Iterable[Told], known: Mapping[str, tuple[str, ...]]) -> list[Told]:
        """Return what the user told that answers their question: *what does Jonas play*, *where does my sister live*."""
        told = list(told)
        for said in self.seen.statements:
            if not said.question:
                continue
            subject = self._called_by_user(said.subject, known) if isinstance(said.triple.subject, str) else ()
            object = said.object.text if isinstance(said.triple.object, str) else None
            found = [
                one
                for one in told
                if any(one.answers(name, _predicate(said), object or None) for name in subject or (None,))
                and (subject or object)
            ]
            if found:
                return found
        return []

    def _called_by_user(self, phrase: Phrase, known: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
        """Return the subjects under which the user may have told about somebody: *my sister*, *Rosa*."""
        if phrase.person == "I":
            return ("I",)
        topic = self._noun(phrase)
        return (phrase.text, *(phrase.names if phrase.names else ()), *(known.get(topic, ()) if topic else ()))

    def remaining_name(self, sentence: str) -> str | None:
        """Return the name in a sentence that only says who speaks: *it's me, Marlene*."""
        words = [word for word in self._tree.words if word.pos in ("PROPN", "NOUN", "X", "ADJ", "VERB")]
        for word in words:
            name = value_of(" ".join(self._run(word)), TOPICS[NAME], self.seen, sure=False)
            if name:
                return name
        return None

    @staticmethod
    def activities() -> frozenset[str]:
        """Return the verbs that a bare answer may begin with."""
        return relations().words["pastimes"]

    def _asked_noun(self, said: nlp.Statement | None) -> str:
        """Return the topic of the noun in *which club am I in*, *which food do I like best*."""
        for word in self._tree.words:
            if word.low in ("which", "what") and self._tree.head(word).pos == "NOUN":
                noun = self._tree.head(word).lemma
                likes = said is not None and said.verb in self._table.words["likes"]
                return favourite(f"favourite {noun}") if likes else self._table.nouns.get(noun, "")
        return ""

    def without_name(self) -> str:
        """Return the topic of a relative that the user has, but does not name: *I have two brothers*."""
        for said in self.seen.statements:
            topic = self._table.nouns.get(said.object.head, "")
            if topic and TOPICS[topic].nouns and said.holds and self._has(said):
                return topic
        return ""

    def free(self) -> list[Told]:
        """Return what the user tells about themselves and others that no topic covers: *Jonas plays the violin*."""
        found: list[Told] = []
        last = ""
        for said in self.seen.statements:
            pronoun = said.subject.text.lower() in ("he", "she", "they")
            subject = last if pronoun and said.verb not in self._table.words["passing"] else self._about(said)
            if said.subject.names or self._noun(said.subject):
                last = said.subject.name or said.subject.text
            if subject and (said.holds or self._happened(said)):
                verb = _predicate(said)
                text = retold(self._tree, said)
                thing = said.object.text
                if not isinstance(said.triple.object, str) or said.triple.predicate.startswith("not "):
                    continue
                found.append(Told(subject, verb, thing, text))
        return found

    # --------------------------------------------------------------------------------------- the flags

    def _asserted(self, said: nlp.Statement) -> bool:
        if said.hearsay or said.conditional or self._is_asked(said):
            return False
        if said.plan and not self._is_habit(said):
            return False
        if self._is_temporal(said):
            return False
        return not said.request or said.subject.text.lower() == "i" or said.verb in ("call", "name")

    def _is_asked(self, said: nlp.Statement) -> bool:
        """Return whether it is asked, and not only beside a question: *my name is Ada, what is yours*."""
        if not said.question or any(isinstance(part, nlp.QuestionWord) for part in said.triple):
            return said.question
        verb, others = self._verb(said), [other for other in self.seen.statements if other is not said]
        first = said.subject.text and verb and self._tree.text.find(said.subject.text) < verb.start
        return not (first and any(isinstance(part, nlp.QuestionWord) for other in others for part in other.triple))

    def _verb(self, said: nlp.Statement) -> Word | None:
        """Return the verb of a statement in the tree."""
        last = said.triple.predicate.split()[-1]
        verbs = [word for word in self._tree.words if word.low == last or word.lemma == said.verb]
        return next((word for word in verbs if word.pos in ("VERB", "AUX")), verbs[0] if verbs else None)

    def _is_temporal(self, said: nlp.Statement) -> bool:
        """Return whether it only names a time that lies ahead: *when I live in Paris, I will eat cheese*."""
        verb = self._verb(said)
        if verb is None or verb.dep != "advcl" or verb.tag in ("VBD", "VBN"):
            return False
        return any(child.low in ("when", "whenever", "once", "until", "before") for child in self._tree.children(verb))

    def _is_habit(self, said: nlp.Statement) -> bool:
        """Return whether a plan is none: *I like to read*, but not *I would like to read*."""
        first = said.triple.predicate.removeprefix("not ").split()
        if first[0] not in self._table.words["likes"] or len(first) < 2:
            return False
        likes = [word for word in self._tree.words if word.lemma == first[0]]
        return not any(aux.low in ("would", "'d") for like in likes for aux in self._tree.children(like, "aux"))

    # --------------------------------------------------------------------------------------- the table

    def _links(self, said: nlp.Statement) -> Iterator[Link]:
        subject, object = said.subject, said.object
        if subject.person == "I":
            yield from self._of_user(said)
        elif said.verb in _INTRODUCED and object.person == "I":
            yield from self._called(said)
        elif object.person == "I" and (topics := self._table.says.get(f"{_predicate(said)} me")):
            yield from (Link(topic, subject) for topic in topics)
        elif topic := self._noun(subject):
            if object.preposition:
                return
            if said.verb == _BE or _predicate(said) in _INTRODUCED:
                sure = (
                    bool(object.names) or subject.head == "name" or said.verb != _BE or TOPICS[topic].kind != "people"
                )
                yield Link(topic, object if object.text and isinstance(said.triple.object, str) else None, sure)
            elif TOPICS[topic].kind == "activity":
                yield Link(topic, subject, value=self._span((self._verb(said) or self._tree.words[0]).text, object))
        elif said.verb == _BE and (topic := self._noun(object)):
            yield Link(topic, subject if isinstance(said.triple.subject, str) else None, sure=topic != NAME)

    def _noun(self, phrase: Phrase) -> str:
        """Return the topic of *my job*, *my sister's name*, *my favourite food*; empty for other phrases."""
        if not phrase.of("I") or phrase.owner is None:
            return ""
        if phrase.head == "name" and phrase.owner.person != "I":
            return self._noun(phrase.owner)
        low = phrase.text.lower()
        if (at := re.search(r"\bfavou?rite (.+)", low)) and phrase.head in at[1]:
            topic = self._table.nouns.get(phrase.head, "")
            return topic if topic == "hobby" else favourite(at[0])
        if phrase.head == "one" and phrase.owner.owner is not None:  # one of my hobbies
            return self._noun(phrase.owner)
        two = " ".join(low.split()[-2:])
        return self._table.nouns.get(two) or self._table.nouns.get(phrase.head, "")

    def _of_user(self, said: nlp.Statement) -> Iterator[Link]:
        predicate, object = _predicate(said), said.object
        likes = self._table.words["likes"]
        verbs = predicate.split()
        asked = isinstance(said.triple.object, nlp.QuestionWord)
        if self._has(said):
            if (topic := self._table.nouns.get(object.head, "")) and (said.negated or object.names or said.question):
                yield Link(topic, object if object.names else None)
            return
        leisure = re.search(
            r"\b(?:free|spare|leisure) time\b|\bfor fun\b|\bas a hobby\b", self._tree.text, re.IGNORECASE
        )
        pastime = verbs[0] in self._table.words["pastimes"] or (leisure and predicate != _BE)
        verb = self._verb(said)
        if verb is not None and verb.tag in ("VBP", "VB") and object.text and not object.preposition and said.holds:
            pastime = pastime or likeness(gerund(self._span(verb.low, object), self.seen), "activity") > 0.2
        if verb is not None and verb.tag == "VBG" and verb.dep == "conj":  # I love climbing and baking bread
            pastime = pastime or any(other.verb in likes and other.holds for other in self.seen.statements)
        if not asked and ((verbs[0] in likes and len(verbs) > 1) or (pastime and verbs[0] not in likes)):
            if (hobby := self._pursuit(said, verbs, object)) is not None:
                yield hobby
                return
        if predicate == _BE:
            yield from self._being(said)
        direct = [object] if object.text and not object.preposition else []
        if not object.text and (dangling := self._dangling(verb)):
            direct = [dangling]
        if object.preposition and object not in said.phrases:
            direct.append(object)
        for phrase in (*direct, *said.phrases):
            head = f" {object.head}" if predicate == _BE and direct and phrase.preposition not in ("", "from") else ""
            topics = self._table.says.get(f"{predicate}{head} {phrase.preposition}".strip(), ())
            if not topics and phrase.preposition:
                topics = self._table.says.get(f"{self._word_before(phrase)} {phrase.preposition}", ())
            for topic in topics:
                yield Link(topic, phrase, predicate != _BE and (phrase.preposition != "in" or topic == "subject"))

    def _dangling(self, verb: Word | None) -> Phrase | None:
        """Return the words after a verb and a preposition that the parser has not recognised: *moved to Basel*."""
        preposition = self._tree.after(verb) if verb is not None else None
        value = (
            self._tree.after(preposition) if preposition is not None and preposition.pos in ("ADP", "PART") else None
        )
        if preposition is None or value is None or value.pos == "PUNCT":
            return None
        return Phrase(" ".join(self._run(value)), preposition=preposition.low)

    def _word_before(self, phrase: Phrase) -> str:
        """Return the word before a phrase and its preposition: a verb that the parser may have mistaken for a noun."""
        found = re.search(
            rf"(\w+) {phrase.preposition} (?:an? |the )?{re.escape(phrase.text)}", self._tree.text, re.IGNORECASE
        )
        return found[1].lower() if found else ""

    def _pursuit(self, said: nlp.Statement, verbs: list[str], object: Phrase) -> Link | None:
        """Return the hobby in *I like to read books*, *I play chess*, *I go swimming*."""
        free = object.head in ("time", "weekend", "fun")
        alone = verbs[0] == "go" or not object.text or object.preposition
        if said.subject.text.lower() != "i" or (len(verbs) == 1 and alone and not free):
            return None
        verb = self._verb(said)
        written = self._span(verb.low if verb else verbs[-1], Phrase("") if free else object)
        return Link("hobby", object if object.text else said.subject, value=written) if written else None

    def _has(self, said: nlp.Statement) -> bool:
        """Return whether the user says what they have: *I have*, *I've got*."""
        got = said.verb == "get" and any(word.low in ("got", "gotten") for word in self._tree.words)
        return said.subject.person == "I" and (said.verb == "have" or got)

    def _being(self, said: nlp.Statement) -> Iterator[Link]:
        """Yield what *I am ...* tells: an age, an occupation, studies, or a name."""
        object = said.object
        if re.fullmatch(r"\d+( years?( old)?| old)?", object.text) or (
            object.head == "old" and len(object.text.split()) == 3
        ):
            number = re.match(r"\d+", object.text)
            yield Link("age", object, value=number[0] if number else str(int(object.amount or 0)))
        elif object.head == "member" and object.owner is not None:
            yield Link("club", object.owner)
        elif object.head == "fan" and object.owner is not None:
            yield Link("liking", object.owner)
        elif object.head == "student":
            yield Link("occupation", object, value="student")
            before = object.text.rpartition(" ")[0]
            if before or object.owner is not None:
                yield Link("subject", object.owner or object, sure=False, value=before)
            yield from (Link("university", phrase) for phrase in said.phrases if phrase.preposition in ("at", "from"))
        elif object.preposition:
            return
        elif object.names and not object.head:
            yield Link(NAME, object, sure=self.asked == NAME)
        elif object.text and not object.of("I"):
            yield Link("occupation", object, sure=self.asked == "occupation")
            yield Link(NAME, object, sure=False)
            yield from (
                Link("employer", phrase) for phrase in said.phrases if phrase.preposition in ("at", "for", "with")
            )

    def _called(self, said: nlp.Statement) -> Iterator[Link]:
        """Yield the name in *call me Tom*, *my friends call me Buzz*."""
        me = next((w for w in self._tree.words if w.low == "me" and self._tree.head(w).lemma == said.verb), None)
        after = self._tree.after(me) if me is not None else None
        if after is not None and after.pos in ("PROPN", "NOUN", "X", "ADJ", "VERB"):
            yield Link(
                NAME, said.object, sure=after.pos == "PROPN" or not said.request, value=" ".join(self._run(after))
            )

    def _ended(self, said: nlp.Statement) -> str:
        """Return the topic that *I quit my job*, *I moved away* ends; empty if there is none."""
        if said.subject_person != "I" or said.past:
            return ""
        parts = (("not " if said.negated else "") + _predicate(said), said.object.head or said.object.text.lower())
        return self._table.ends.get(" ".join(filter(None, parts)), "")

    def _mentioned(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield the relatives that the user names: *my sister Rosa*, *my mother's name is Anna*, *a son named Ben*."""
        if any(said.question or said.conditional or said.hearsay for said in self.seen.statements):
            return
        for said in self.seen.statements:
            for phrase in (said.subject, said.object, *said.phrases):
                mine = phrase.of("I") or (self._has(said) and not said.negated)
                topic, names = self._named(phrase)
                if topic and names and mine:
                    yield topic, self._people(topic, names)
        words = self._tree.words
        for index, word in enumerate(words):
            mine = word.low == "name" and index and words[index - 1].low == "my"
            topic = NAME if mine else self._relative(word.lemma)
            rest = words[index if mine else index + 1 :]
            passed = list(itertools.takewhile(lambda other: other.low in _NAMING, rest))
            if mine and not ({"'s", "’s"} & {other.low for other in passed} and rest[len(passed) :]):
                continue
            if (
                topic
                and {"name", "names", "called", "named"} & {other.low for other in passed}
                and len(passed) < len(rest)
            ):
                first = rest[len(passed)]
                names = [" ".join(self._run(one)) for one in (first, *self._joined(first)) if one.pos in _NOUNS]
                yield topic, self._people(topic, names)

    def _named(self, phrase: Phrase) -> tuple[str, tuple[str, ...]]:
        """Return the topic and the names of *my sister Rosa*, also where the parser takes the name for the noun."""
        if topic := self._relative(phrase.head):
            return topic, self._names(phrase)
        words = phrase.text.split()
        topic = self._relative(words[-2].lower()) if len(words) == 3 else ""
        return topic, (words[-1],) if topic else ()

    def _relative(self, noun: str) -> str:
        """Return the topic of a relative, a friend or a pet; empty for other nouns."""
        topic = self._table.nouns.get(noun, "")
        return topic if topic and TOPICS[topic].nouns else ""

    def _people(self, topic: str, names: Iterable[str]) -> tuple[str, ...]:
        return tuple(filter(None, (value_of(name, TOPICS[topic], self.seen) for name in names)))

    # -------------------------------------------------------------------------------------- the values

    def _values(self, link: Link) -> tuple[str, ...]:
        if link.phrase is None:
            return ()
        topic = TOPICS[link.topic]
        if topic.kind in ("people", "name") and not link.value:
            phrase = link.phrase.owner if link.phrase.head == "name" and link.phrase.owner else link.phrase
            raw = (topic.kind == "people" and self._names(phrase)) or (self._written(phrase),)
        elif link.value:
            raw = (link.value,)
        else:
            raw = (self._written(link.phrase),)
        sure = link.sure or link.topic == self.asked
        return tuple(filter(None, (value_of(text, topic, self.seen, sure=sure) for text in raw)))

    def _written(self, phrase: Phrase) -> str:
        """Return a phrase with its article, as in the utterance."""
        inner = r"\s+(?:(?:the|an?)\s+)?".join(map(re.escape, phrase.text.split()))
        found = re.search(
            rf"(?<![\w'])(?:(?:the|an?|our|this|that|these|those)\s+)?{inner}(?!\w)(?:-[\w-]+|\s(?:am|an der|upon|de|del)\s\w+)*",
            self._tree.text,
            re.IGNORECASE,
        )
        return found[0] if found else phrase.name or phrase.text

    def _span(self, verb: str, object: Phrase) -> str:
        """Return a verb with its object and all between them."""
        found = re.search(
            rf"\b{re.escape(verb)}\w*\b(?:.{{0,40}}?{re.escape(object.text)})?", self._tree.text, re.IGNORECASE
        )
        return found[0] if found else ""

    def _names(self, phrase: Phrase) -> tuple[str, ...]:
        """Return the names of a phrase, with those joined to them: *Max and Tom*."""
        names = list(phrase.names)
        for name in phrase.names:
            last = name.split()[-1]
            for word in self._tree.words:
                if word.text == last:
                    names += [" ".join(self._run(other)) for other in self._joined(word)]
        return tuple(dict.fromkeys(names))

    def _joined(self, word: Word) -> Iterator[Word]:
        for other in self._tree.children(word, "conj"):
            if other.pos in ("PROPN", "NOUN", "X") and not self._tree.children(other, "det", "poss", "nsubj"):
                yield other
                yield from self._joined(other)

    def _run(self, word: Word) -> list[str]:
        """Return the words of a name."""
        left = [child.text for child in self._tree.children(word, "compound") if child.index < word.index]
        run = [*left, word.text]
        while (after := self._tree.after(word)) is not None and after.pos == "PROPN" and after.start == word.end + 1:
            run.append(after.text)
            word = after
        return run

    # ----------------------------------------------------------------------------------- free statements

    def _about(self, said: nlp.Statement) -> str:
        """Return the subject of a statement that is worth keeping, an empty string for others."""
        words, subject = self._table.words, said.subject
        verb = said.verb
        if " to " in said.triple.predicate or said.object.person != "other":
            return ""
        if verb in words["passing"] or not isinstance(said.triple.object, str) or self._ended(said):
            return ""
        if subject.person == "I":
            thing = said.object
            fits = thing.text and not thing.preposition and verb not in (_BE, "have") and thing.person == "other"
            mine = "my" in thing.text.lower().split() and not self._happened(said)
            new = not mine and not list(self._links(said))
            return "I" if fits and new and self._is_new(thing) else ""
        topic, names = self._named(subject)
        if topic and subject.of("I"):
            if verb == _BE and (said.object.names or not said.object.text):
                return ""
            return names[0] if names else subject.text
        mine = subject.text.lower().split() if subject.of("I") else []
        if words["kin"] & {subject.head, *mine[1:2]}:
            return " ".join(subject.text.split()[2:]) if len(mine) == 3 else subject.text
        if subject.names and not subject.head and self._is_person(subject):
            return subject.text if not self._noun(said.object) else ""
        return ""

    def _happened(self, said: nlp.Statement) -> bool:
        """Return whether it is an event of the past: *I painted a dragon*, but not *I lived in Rome*."""
        verb = self._verb(said)
        flags = said.negated or said.hearsay or said.conditional or said.plan or said.question or said.request
        return not flags and verb is not None and verb.tag == "VBD" and said.verb not in self._table.words["states"]

    def _is_new(self, phrase: Phrase) -> bool:
        return self._written(phrase).split()[0].lower() not in ("this", "that", "these", "those")

    def _is_person(self, phrase: Phrase) -> bool:
        return bool(value_of(phrase.text, TOPICS[NAME], self.seen, sure=False))


def _predicate(said: nlp.Statement) -> str:
    return said.triple.predicate.removeprefix("not ")


def _add(told: dict[str, tuple[str, ...]], topic: str, values: Iterable[str]) -> None:
    kind = TOPICS[topic]
    before = told.get(topic, ())
    if kind.many or not before:
        told[topic] = tuple(dict.fromkeys((*before, *(values if kind.many else list(values)[:1]))))
