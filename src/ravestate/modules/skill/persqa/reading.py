"""The facts that an utterance tells or asks for, read from its statements."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.tree import Word

from .kinds import likeness
from .topics import ASKS, ENDS, NAME, NOUNS, SAYS, TOPICS, WORDS, Fact, favourite
from .values import gerund, is_gerund, number_in, value_of
from .wording import Facts, alike, among, without

LASTING = frozenset(["subject", "university", "birthplace", "childhood"])
"""Topics whose facts may be in the past tense: *I studied law*."""
_CALLED = frozenset(["be", "be called", "be named"])
_ANY = re.compile(r"(?:any|there$|here$)", re.IGNORECASE)
_LEISURE = re.compile(r"\b(?:free|spare|leisure) time\b|\bfor fun\b|\bas a hobby\b", re.IGNORECASE)
_NAMING = frozenset(["'s", "'", "s", "name", "names", "is", "are", "called", "named", ",", "who", "that", ":"])
"""Words between a relative and their name: *my mother's name is Anna*."""
_TURN = re.compile(
    r"(?:, (?:and )?|(?<! am)(?<! is)(?<! are)(?<!'m)(?<!'s)(?<!'re) (?=not (?:an?|the|in|at|from) [\w ]+\W*$))(not) |"
    r",? but (?!i\b)",
    re.IGNORECASE,
)
_NOT = re.compile(r"n['’]t\b|\b(?:not?|never)\b", re.IGNORECASE)
_HERE = re.compile(
    r"^(?:(?:hi|hello|hey)\b\W*|\w+[.!,;] )?(?:it['’]?s |this is )?((?:\w+ )?\w+) (?:again )?here(?=[.!,;]|$| (?:again|and|from)\b)",
    re.IGNORECASE,
)
_OPENING_NO = re.compile(r"(?:^|[.!?;,] )no\b(?! \w+ (?:is|was|has|can)\b)", re.IGNORECASE)
_INSTEAD = re.compile(r"\bno,? wait\b|\bwait,? no\b|\bI mean\b|\bsorry, ", re.IGNORECASE)
"""Words with which speakers correct themselves: *I'm Voss, no wait, I'm Claudia*."""
_NONE = frozenset(["none", "neither", "nobody"])
_TODAY = frozenset(["tonight", "today", "tomorrow", "now", "this"])
_NOMINAL = frozenset(["PROPN", "NOUN", "X", "ADJ"])


@dataclass(frozen=True, slots=True)
class Link:
    """A topic in a statement, and the phrase with its value. The phrase is None if the statement gives no value."""

    topic: str
    phrase: Phrase | None = None
    sure: bool = True
    """Whether the words before the value can only introduce this topic: *my name is*."""
    value: str = ""
    """The value, if it differs from the phrase."""


class Reader:
    """The facts in an utterance.

    Args:
        seen: The analysis of the utterance.
        asked: The topic of the agent's open question, or an empty string.
        person: The topic of the relative whom *he* or *his* means, or an empty string.
    """

    def __init__(self, seen: nlp.Analysis, asked: str = "", person: str = "") -> None:
        self.seen = seen
        self.tree = seen.tree
        self.words = {word.low for word in seen.tree.words}
        self.asked = asked
        mine = (said.object for said in seen.statements if said.subject.person == "I" or said.object.of("I"))
        owned = (self.relative(object.head) for object in mine)
        self.person = person or next(filter(None, owned), "")

    def facts(self, known: Facts | None = None) -> list[Fact]:
        """Return the facts that the user states, one for each topic; `known` are the earlier facts."""
        told: dict[str, tuple[str, ...]] = {}
        gone: dict[str, tuple[str, ...]] = {}
        denied = ""  # the topic of the last denial: "my name isn't Ada, it's Ida"
        for said in filter(self._asserted, self.seen.statements):
            if topic := self.ended(said):
                gone.setdefault(topic, ())
                continue
            instead = denied and said.verb == "be" and said.subject.text.lower() == "it"
            for link in [Link(denied, said.object)] if instead else self.links(said):
                denied = link.topic if said.negated else ""
                values = self.values(link)
                called = TOPICS[link.topic].kind == "people" and said.subject.head == "name"  # "his name was Joost"
                over = (said.past and link.topic not in LASTING and not called) or (
                    link.topic == NAME and not self.words.isdisjoint({"was", "were"})
                )
                if self._denies(said, link.phrase) or (
                    over and values and among(values[0], (known or {}).get(link.topic, ()))
                ):
                    if values or link.phrase is None or _ANY.match(link.phrase.text):
                        meant = tuple(one for one in (known or {}).get(link.topic, ()) if alike(one, values))
                        gone.setdefault(link.topic, meant or values)
                elif not over:
                    if values and _INSTEAD.search(self.tree.text):
                        told.pop(link.topic, None)
                    _add(told, link.topic, values)
        for topic, values in self.named():
            if topic not in gone and (topic != NAME or topic not in told):
                _add(told, topic, values)
        if told and (found := _INSTEAD.search(self.tree.text)):  # "Ada here, no wait, it's Ida"
            for said in self.seen.statements:
                later = said.verb == "be" and said.subject.text.lower() == "it"
                if later and self.tree.text.find(said.object.text) > found.end():
                    topic = [*told][-1]
                    told[topic] = self._fitting(topic, [said.object.text]) or told[topic]
        if self.asked == "home" and "origin" in told and "home" not in told:
            told["home"] = told.pop("origin")
        for topic in told:  # "I live in Paris. I don't live in Paris."
            told[topic] = without(told[topic], gone.get(topic, ()))
        struck = [Fact(topic, values, gone=True) for topic, values in gone.items() if values or topic not in told]
        return [*(Fact(topic, values) for topic, values in told.items() if values), *struck]

    def _denies(self, said: nlp.Statement, phrase: Phrase | None) -> bool:
        """Return whether a negation covers a phrase.

        It covers *Bonn* in *I live in Ulm, not in Bonn*, and in *I don't live in Bonn, but in Ulm*.
        """
        text, turn = self.tree.text, _TURN.search(self.tree.text)
        if not _NOT.search(_OPENING_NO.sub("", text)):
            return False
        twice = turn and turn[1] and _NOT.search(text[: turn.start()])
        if turn is None or twice or not said.negated or phrase is None:
            return said.negated
        return (phrase.text in text[turn.end() :]) == bool(turn[1])

    def asks(self) -> Fact | None:
        """Return the fact that the user asks for. It has values if the user wants these values confirmed."""
        kinds = nlp.QuestionWord
        for said in self.seen.statements:
            if not said.question or said.conditional:
                continue
            parts = (said.triple.object, said.triple.subject, self.seen.question)
            unknown = next((part for part in parts if isinstance(part, kinds) and part != kinds.YES_NO), None)
            if unknown is not None and said.subject.person == "I":
                asked = f"{_predicate(said)} {unknown.name}"
                keys = (*(f"{asked} {phrase.head}" for phrase in said.phrases), asked)
                keys = (*keys, f"know {asked}") if self.words & {"know", "remember"} else keys
                if topic := self._asked_noun(said) or next(filter(None, map(ASKS.get, keys)), ""):
                    return Fact(topic)
            for link in self.links(said):
                people = TOPICS[link.topic].kind == "people"
                values = () if unknown else self.values(link)
                wanted = unknown in (kinds.PERSON, kinds.OBJECT, kinds.PLACE) or (unknown and said.verb == "call")
                if values or wanted or (unknown is None and (people or link.phrase is None)):
                    return Fact(link.topic, values)
        return None

    def _asked_noun(self, said: nlp.Statement) -> str:
        """Return the topic of the noun in *which club am I in*, *which food do I like best*."""
        for word, noun in itertools.pairwise(self.tree.words):
            if word.low in ("which", "what", "many") and noun.pos == "NOUN":
                likes = said.verb in WORDS["likes"]
                return favourite(f"favourite {noun.lemma}") if likes else NOUNS.get(noun.lemma, "")
        return ""

    def without_name(self) -> str:
        """Return the topic of a relative that the user has, but does not name: *I have two brothers*."""
        had = (self.relative(said.object.head) for said in self.seen.statements if said.holds and self._has(said))
        return next(filter(None, had), "")

    def remaining_name(self) -> str:
        """Return the name in an utterance that only says who speaks: *it's me, Marlene*; empty if there is none."""
        runs = (value_of(self._run(word), TOPICS[NAME], self.seen, sure=False) for word in self.tree.words)
        return next(filter(None, runs), "")

    # ---------------------------------------------------------------------------------- statements to topics

    def _asserted(self, said: nlp.Statement) -> bool:
        if said.hearsay or said.conditional or said.question or (said.plan and not self._is_habit(said)):
            return False
        thing = said.object.text
        if self.words & _NONE:
            return False
        if thing and any(thing in other.when and "when" in other.when for other in self.seen.statements):
            return False  # "when I live in Paris, I will eat cheese"
        return not said.request or said.subject.text.lower() == "i"

    def _is_habit(self, said: nlp.Statement) -> bool:
        """Return whether a statement flagged as a plan is a habit: *I like to read*, but not *I would like to read*."""
        first = _predicate(said).split()[0]
        likes = [word for word in self.tree.words if word.lemma == first]
        return first in WORDS["likes"] and not any(
            aux.low in ("would", "'d") for aux in self.tree.children_of(likes, "aux")
        )

    def links(self, said: nlp.Statement) -> Iterator[Link]:
        """Yield the topics of a statement."""
        subject, object, predicate = said.subject, said.object, _predicate(said)
        if subject.person == "I":
            yield from self._of_user(said)
        elif object.person == "I" and (found := SAYS.get(f"{predicate} me")):
            yield Link(found[0], subject, found[1])
        elif subject.of("I") and (found := SAYS.get(f"my {subject.head} {predicate} {object.preposition}")):
            yield Link(found[0], object, found[1])
        elif topic := self.noun(subject):
            if predicate in _CALLED and not object.preposition:
                sure = (
                    bool(object.names) or (subject.head == "name" and subject.owner) or TOPICS[topic].kind != "people"
                )
                yield Link(topic, object if object.text and isinstance(said.triple.object, str) else None, bool(sure))
            elif TOPICS[topic].kind == "activity" and (verb := self.verb(said)):
                yield Link(topic, subject, value=self._span(verb.text, object))
        elif said.verb == "be" and (topic := self.noun(object)):
            yield Link(topic, subject if isinstance(said.triple.subject, str) else None, sure=topic != NAME)

    def noun(self, phrase: Phrase) -> str:
        """Return the topic of *my job*, *my sister's name*, *my favourite food*; empty for other phrases."""
        owner = phrase.owner
        if phrase.text.lower() == "name":  # "name is Ada, the name's Ada"
            return NAME
        theirs = owner and owner.text.lower() in ("his", "her") and phrase.head == "name"
        if theirs or phrase.text.lower() in ("he", "she"):
            return self.person
        if owner is None or not phrase.of("I") or is_former(phrase.text):
            return ""
        if (phrase.head == "name" and owner.person != "I") or (phrase.head == "one" and owner.owner is not None):
            return self.noun(owner)  # "my sister's name, one of my hobbies"
        low = phrase.text.lower()
        topic = NOUNS.get(" ".join(low.split()[-2:])) or NOUNS.get(phrase.head, "")
        best = re.search(r"\bfavou?rite .+", low)
        return favourite(best[0]) if best and phrase.head in best[0] and topic != "hobby" else topic

    def _of_user(self, said: nlp.Statement) -> Iterator[Link]:
        predicate, object = _predicate(said), said.object
        verb = self.verb(said)
        if verb is not None and verb.dep == "relcl":
            return  # "the film that I like"
        has = self._has(said)
        if has and (topic := NOUNS.get(object.head, "")) and (said.negated or said.question):
            yield Link(topic, object if object.names else None)
        told = list(self._by_table(said, has=has))
        hobby = self._pursuit(said) if all(link.topic == "liking" or not link.sure for link in told) else None
        yield from [hobby] if hobby else [*(self._being(said) if predicate == "be" else ()), *told]

    def _by_table(self, said: nlp.Statement, *, has: bool) -> Iterator[Link]:
        """Yield the topics that the table has for *live in* (verb, preposition) or *have a job at* (with an object)."""
        predicate, object = _predicate(said), said.object
        child = any(phrase.preposition == "as" and phrase.head in WORDS["young"] for phrase in said.phrases)
        for phrase in dict.fromkeys((object, *said.phrases)):
            nominal = predicate == "be" and not object.preposition and phrase.preposition not in ("", "from")
            before = f"{self._word_before(phrase)} {phrase.preposition}"
            keys = [f"{'have' if has else predicate} {object.head} {phrase.preposition}"] if phrase != object else []
            keys += (
                []
                if nominal or (predicate == "be" and phrase != object and phrase.preposition != "from")
                else [f"{predicate} {phrase.preposition}".strip()]
            )
            found = next(filter(None, map(SAYS.get, (*keys, before))), None)
            if phrase.text and found:
                topic = "childhood" if child and found[0] == "home" else found[0]
                yield Link(topic, phrase, found[1])
                if topic == "childhood" and "born" in self.tree.text:
                    yield Link("birthplace", phrase)  # "I was born and raised in Dresden"

    def _pursuit(self, said: nlp.Statement) -> Link | None:
        """Return the hobby in *I like to read books*, *I play chess*, *I go swimming*, *I paint in my free time*."""
        verbs, object = _predicate(said).split(), said.object
        verb = self.verb(said)
        if verb is None or said.subject.text.lower() != "i" or not isinstance(said.triple.object, str):
            return None
        chained, direct = len(verbs) > 1, object.text and not object.preposition
        free = object.head in ("time", "weekend", "fun")
        written = self._span(verb.low, Phrase("") if free else object)
        if verb.tag in ("VBN", "VBZ"):
            written = re.sub(r"^\w+", verb.lemma, written)
        if verbs[0] in WORDS["likes"]:
            wanted = chained
        elif verbs == ["do"] and direct and said.holds and likeness(object.text, "activity") > 0.2:
            wanted, written = True, object.text  # "I do judo"
        elif verbs[0] in WORDS["pastimes"]:
            wanted = verb.tag != "VBD" and (chained or object.text.endswith("ing") if verbs[0] == "go" else direct)
        elif verb.tag == "VBG" and verb.dep == "conj":  # "I love climbing and baking bread"
            wanted = any(other.verb in WORDS["likes"] and other.holds for other in self.seen.statements)
        elif verbs[0] != "be" and _LEISURE.search(self.tree.text):
            wanted = direct or free
        else:
            habit = verbs[0] != "be" and said.holds and verb.tag in ("VBP", "VB") and not chained
            habit = (
                habit
                and not free
                and not _TODAY & set(said.when.split())
                and (direct or not (object.text or said.phrases))
            )
            wanted = habit and likeness(gerund(written, self.seen), "activity") > (0.2 if direct else 0.4)
        return Link("hobby", object if object.text else said.subject, value=written) if wanted and written else None

    def _has(self, said: nlp.Statement) -> bool:
        """Return whether the user says that they have something: *I have*, *I've got*."""
        got = said.verb == "get" and any(word.low == "got" for word in self.tree.words)
        return said.subject.person == "I" and (said.verb in ("have", "own") or got)

    def _being(self, said: nlp.Statement) -> Iterator[Link]:
        """Yield the links of *I am ...*: an age, an occupation, studies, or a name."""
        object, text = said.object, said.object.text
        years = re.fullmatch(r"([\w -]+?)(?: years?(?: old)?| old)?", text.lower())
        if years and not object.preposition and (number := number_in(years[1])):  # not *for six years*
            yield Link("age", object, value=number)
        elif object.owner is not None and (found := SAYS.get(f"be {object.head} of")):
            yield Link(found[0], object.owner)
        elif object.head == "student":
            yield Link("occupation", object, value="student")
            yield Link(
                "subject", object.owner or object, sure=False, value="" if object.owner else text.rpartition(" ")[0]
            )
            yield from (Link("university", phrase) for phrase in said.phrases if phrase.preposition in ("at", "from"))
        elif not object.preposition and ((object.names and not object.head) or self._is_capital(object)):
            yield Link(NAME, object, sure=self.asked == NAME or self._is_capital(object))
            ages = (word for word in self.tree.words if word.dep == "appos" and word.pos == "NUM")  # "I'm Ada, 36"
            yield from (Link("age", object, value=word.text) for word in ages)
        elif text and not object.preposition and not object.of("I") and object.head not in ("old", "half"):
            several = any(word.lemma == object.head and word.tag == "NNS" for word in self.tree.words)
            if several and said.subject.text.lower() == "i":
                return  # "I'm all ears"
            bare = len(text.split()) == 1 and not re.match("(?:an?|the) ", self.written(object))
            if not bare or self.asked == "occupation" or likeness(text, "work") > 0.3:  # "I'm noor"
                yield Link("occupation", object, sure=self.asked == "occupation")
            yield Link(NAME, object, sure=False)
            places = (phrase for phrase in said.phrases if phrase.preposition in ("at", "for", "with"))
            yield from (Link("employer", phrase, sure=False) for phrase in places)

    def _is_capital(self, phrase: Phrase) -> bool:
        """Return whether words begin with a capital as a name does: *I am Anneke*, but not *I am Greek*, *I'm a Leo*."""
        found = re.search(rf"(\w+) {re.escape(phrase.text)}(?!\w)", self.seen.text)
        labels = {entity.label for entity in self.seen.entities if phrase.text in entity.text} - {"PERSON", "ORG"}
        return bool(found and phrase.text.istitle() and not labels and found[1].lower() not in WORDS["determiners"])

    def ended(self, said: nlp.Statement) -> str:
        """Return the topic whose value a statement ends, such as *I quit my job*; empty if there is none."""
        predicate = ("not " if said.negated else "") + _predicate(said)
        ended = ENDS.get(f"{predicate} {said.object.head or said.object.text.lower()}".strip(), "")
        return ended if said.subject.person == "I" and not said.past else ""

    def named(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Yield the relatives that the user names, with their names: *my sister Rosa*, *my mother's name is Anna*,
        *a son named Ben*, *call me Tom*.

        The parser often misses the second of two relatives, so this method reads the words one by one."""
        unsaid: set[str] = set()
        whole: list[tuple[str, tuple[str, ...]]] = []
        for said in self.seen.statements:
            phrases = (said.subject, said.object, *said.phrases)
            allowed = said.verb == "call" and said.subject.person == "you"  # "you may call me Fitz"
            open = (said.question or said.conditional or said.hearsay or said.plan) and not allowed
            open = open or (said.past and not said.subject.names)
            if open or (said.negated and said.verb == "call"):
                unsaid |= {said.verb, *said.object.text.split(), *(phrase.head for phrase in phrases)}
            for phrase in phrases if not open else ():
                mine = phrase.of("I") or (self._has(said) and not said.negated)
                if phrase.names and mine and not is_former(phrase.text) and (topic := self.relative(phrase.head)):
                    whole.append((topic, self._fitting(topic, phrase.names)))
        words = self.tree.words
        if here := _HERE.search(self.tree.text):
            sure = any(word.text == here[1] and word.pos == "PROPN" for word in words)
            yield NAME, self._fitting(NAME, [here[1]], sure=sure)
        beside: dict[str, str] = {}
        for before, word in itertools.pairwise(words):
            own = (before.low, word.low) == ("my", "name")  # "my name's Tom"
            me = before.lemma == "call" and before.tag != "VBD" and word.low == "me"
            topic = NAME if own or me else self.relative(word.lemma)
            if not topic or (topic != NAME and self._is_anothers(word)):
                continue
            passed = [one.low for one in itertools.takewhile(lambda one: one.low in _NAMING, words[word.index + 1 :])]
            first = words[word.index + 1 + len(passed) :][:1]
            if not first or unsaid & {word.lemma, before.lemma} or self.words & _NONE:
                continue
            named = me or {"'s"} & set(passed[:own]) or {"name", "names", "called", "named"} & set(passed)
            if {one.pos for one in first} == {"PROPN"}:  # "my sister Rosa; a dog, Rex, and a cat, Misty"
                named = named or (not passed and before.low in ("my", "our"))
                named = named or (passed == [","] and (word.tag == "NNS" or before.low in ("a", "an", "my", "our")))
            if named and not is_former(f"{words[max(0, before.index - 1)].low} {before.low} {passed[:1]}"):
                values = self._fitting(topic, map(self._run, (*first, *self._joined(first[0]))))
                beside |= dict.fromkeys(values, topic)
                yield topic, values
        for topic, values in whole:
            yield topic, tuple(value for value in values if beside.get(value, topic) == topic)

    def _is_anothers(self, word: Word) -> bool:
        """Return whether a relative is somebody else's: *he's got a new girlfriend called Tamara*."""
        if any(child.low in ("my", "our") for child in self.tree.children(word, "poss")):
            return False
        having = [said for said in self.seen.statements if said.object.head == word.lemma]
        return any(said.subject.person == "other" and said.subject.text.lower() != "it" for said in having)

    def relative(self, noun: str) -> str:
        """Return the topic of a relative, a friend or a pet; empty for other nouns."""
        topic = NOUNS.get(noun, "")
        return topic if topic and TOPICS[topic].kind == "people" else ""

    # ----------------------------------------------------------------------------------------------- words

    def values(self, link: Link) -> tuple[str, ...]:
        topic, phrase = TOPICS[link.topic], link.phrase
        if phrase is None:
            return ()
        if topic.kind in ("people", "name") and phrase.head == "name" and phrase.owner:
            phrase = phrase.owner  # "by the name of Blackbeard"
        raw = (phrase.names if topic.kind == "people" else ()) or (link.value or self.written(phrase),)
        return self._fitting(link.topic, raw, sure=link.sure or link.topic == self.asked == NAME)

    def _fitting(self, topic: str, raw: Iterable[str], *, sure: bool = True) -> tuple[str, ...]:
        return tuple(filter(None, (value_of(text, TOPICS[topic], self.seen, sure=sure) for text in raw)))

    def verb(self, said: nlp.Statement) -> Word | None:
        """Return the verb of a statement in the tree."""
        last = said.triple.predicate.split()[-1]
        verbs = [word for word in self.tree.words if word.low == last or word.lemma == said.verb]
        return min(verbs, key=lambda word: word.pos not in ("VERB", "AUX"), default=None)

    def written(self, phrase: Phrase) -> str:
        """Return a phrase with its article, as in the utterance."""
        inner = r"\s+(?:(?:the|an?)\s+)?".join(map(re.escape, phrase.text.split()))
        articles = r"(?:(?:the|an?|our|this|that|these|those)\s+)?"
        name = r"(?:-[\w-]+|\s&\s\w+|\s(?:am|an der|upon|de|del)\s\w+)*"  # "Stoke-on-Trent, Frankfurt am Main"
        found = re.search(rf"(?<![\w']){articles}{inner}(?!\w){name}", self.tree.text, re.IGNORECASE)
        return found[0] if found else phrase.name or phrase.text

    def _span(self, verb: str, object: Phrase) -> str:
        """Return a verb, its object, and the words between them."""
        end = rf"(?:.{{0,40}}?{re.escape(object.text)})?"
        found = re.search(rf"\b{re.escape(verb)}\w*\b{end}", self.tree.text, re.IGNORECASE)
        return found[0] if found else ""

    def _word_before(self, phrase: Phrase) -> str:
        """Return the word before a phrase and its preposition: a verb that the parser may have mistaken for a noun."""
        pattern = rf"(\w+) {phrase.preposition} (?:an? |the )?{re.escape(phrase.text)}"
        found = re.search(pattern, self.tree.text, re.IGNORECASE) if phrase.preposition else None
        return found[1].lower() if found else ""

    def _joined(self, word: Word) -> Iterator[Word]:
        """Yield the names that *and* joins to a name."""
        for other in self.tree.children(word, "conj"):
            if other.pos in _NOMINAL and not self.tree.children(other, "det", "poss", "nsubj"):
                yield other
                yield from self._joined(other)

    def _run(self, word: Word) -> str:
        """Return the name of one or more words that begins with `word`; empty if no name begins there."""
        if word.pos not in (*_NOMINAL, "VERB"):
            return ""
        first = (child for child in self.tree.children(word, "compound") if child.index < word.index)
        run = [*(child for child in first if not self.relative(child.lemma)), word]
        while (after := self.tree.after(word)) and after.pos == "PROPN" and after.start == word.end + 1:
            run.append(after)
            word = after
        return " ".join(one.text for one in run)


def is_former(words: str) -> bool:
    return bool(WORDS["former"] & set(re.split(r"\W", words.lower())))


def _predicate(said: nlp.Statement) -> str:
    return said.triple.predicate.removeprefix("not ")


def _add(told: dict[str, tuple[str, ...]], topic: str, values: Iterable[str]) -> None:
    for value in values:
        one = "hobby" if topic == "liking" and is_gerund(value) else topic
        before = told.get(one, ())
        if value not in before and (TOPICS[one].many or not before):
            told[one] = (*before, value)
