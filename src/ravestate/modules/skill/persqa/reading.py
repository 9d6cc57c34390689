"""The facts that an utterance tells or asks for, read from its statements."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.tree import Word

from .being import being_in, beside_name
from .changes import denied_by, ended_by, is_partial, renamed_in, switched_in
from .fragments import fragments_in
from .frames import framed_in
from .link import Link
from .links import predicate_of, pursuit_in, trade_in
from .relatives import named_in
from .topics import ASKS, LASTING, NAME, NOUNS, SAYS, TOPICS, WORDS, Fact, favourite
from .utterance import MINE, Utterance
from .values import is_gerund
from .wording import alike, among, without

_CALLED = frozenset(["be", "be called", "be named", "be spelled", "be spelt", "be written"])
_ANY = re.compile(r"(?:any|there$|here$)", re.IGNORECASE)
_INSTEAD = re.compile(r"\bno,? wait\b|\bwait,? no\b|\bI mean\b|\bsorry, ", re.IGNORECASE)
"""Words with which speakers correct themselves: *I'm Voss, no wait, I'm Claudia*."""


class Reader(Utterance):
    """The facts in an utterance: those that the user states, and the one that the user asks for."""

    def facts(self) -> list[Fact]:
        """Return the facts that the user states or denies, at most one of each for a topic."""
        told: dict[str, tuple[str, ...]] = {}
        gone: dict[str, tuple[str, ...]] = {}
        denied = ""  # the topic of the last denial: "my name isn't Ada, it's Ida"
        for said in filter(self._asserted, (*self.seen.statements, *fragments_in(self))):
            if ended := ended_by(self, said):
                gone |= {topic: gone.get(topic, ()) + values for topic, values in ended.items()}
                continue
            for old, new, name in renamed_in(self, said):
                gone[old] = (name,)
                _add(told, new, [name] if new else ())
            instead = denied and said.verb == "be" and said.subject.text.lower() == "it"
            for link in [Link(denied, said.object)] if instead else self.links(said):
                denied = link.topic if said.negated else ""
                values = self.values(link, denied=said.negated and link.topic == NAME)
                called = TOPICS[link.topic].kind == "people" and said.subject.head == "name"  # "his name was Joost"
                over = (said.past and link.topic not in LASTING and not called) or (
                    link.topic == NAME and not self.words.isdisjoint({"was", "were"})
                )
                known = self.known.get(link.topic, ())
                if said.negated or self._dislikes(said) or (over and values and among(values[0], known)):
                    said_so = (*values, link.phrase.text if link.phrase else "")
                    fits = alike if TOPICS[link.topic].kind == "activity" else among
                    meant = tuple(one for one in known if fits(one, said_so))
                    named = values or meant or link.phrase is None or _ANY.match(link.phrase.text)
                    lasts = not meant or denied_by(self, said, link.phrase) or TOPICS[link.topic].kind == "name"
                    if named and lasts:
                        gone.setdefault(link.topic, meant or values)
                elif not over:
                    if values and _INSTEAD.search(self.tree.text):
                        told.pop(link.topic, None)
                    _add(told, link.topic, values)
        people = {value for topic, values in named_in(self) if topic != NAME for value in values}
        for topic in [
            topic for topic in told if TOPICS[topic].kind not in ("people", "name")
        ]:  # "a fish named Bubbles"
            told[topic] = without(told[topic], people)
        for topic, values in named_in(self):
            if topic not in gone and (topic != NAME or topic not in told):
                _add(told, topic, values)
        if told and (found := _INSTEAD.search(self.tree.text)):  # "Ada here, no wait, it's Ida"
            topic, rest = [*told][-1], [word for word in self.tree.words if word.start >= found.end()]
            if rest and not any(word.pos in ("VERB", "AUX") for word in rest):  # "I live in Bern. I mean Bonn."
                fixed = self.fitting(topic, [next((word.text for word in rest if word.pos == "PROPN"), "")])
                told[topic] = fixed or told[topic]
            for said in self.seen.statements:
                later = said.verb == "be" and said.subject.text.lower() == "it"
                if later and self.tree.text.find(said.object.text) > found.end():
                    told[topic] = self.fitting(topic, [said.object.text]) or told[topic]
        if self.asked == "home" and "origin" in told and "home" not in told:
            told["home"] = told.pop("origin")
        for topic in told:  # "I live in Paris. I don't live in Paris."
            told[topic] = without(told[topic], gone.get(topic, ()))
        struck = [Fact(topic, values, gone=True) for topic, values in gone.items() if values or topic not in told]
        return [*(Fact(topic, values) for topic, values in told.items() if values), *struck]

    def asks(self) -> Fact | None:
        """Return the fact that the user asks for. Its values are those to confirm or deny: *do I live in Ulm*."""
        kinds = nlp.QuestionWord
        for said in self.seen.statements:
            if not said.question or said.conditional:
                continue
            parts = (said.triple.object, said.triple.subject, self.seen.question)
            unknown = next((part for part in parts if isinstance(part, kinds) and part != kinds.YES_NO), None)
            if unknown is not None and said.subject.person == "I":
                asked = f"{predicate_of(said)} {unknown.name}"
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
        had = (self.relative(said.object.head) for said in self.seen.statements if said.holds and self.has(said))
        return next(filter(None, had), "")

    # ---------------------------------------------------------------------------------- statements to topics

    def _asserted(self, said: nlp.Statement) -> bool:
        if said.hearsay or said.conditional or said.question or (said.plan and not self._is_habit(said)):
            return False
        thing = said.object.text
        verb = self.verb(said)
        if self.is_denied(said):
            return False
        if verb is not None and verb.dep == "xcomp" and self.tree.head(verb).low == "about":
            return False  # "I was about to move"
        if any(phrase.preposition == "in" and phrase.head in WORDS["fiction"] for phrase in said.phrases):
            return False
        if self.denies_all or self.mistaken or "not_meant" in self.seen.acts or is_partial(self, said):
            return False
        if thing and any(thing in other.when and "when" in other.when for other in self.seen.statements):
            return False  # "when I live in Paris, I will eat cheese"
        return not said.request or said.subject.text.lower() == "i"

    def _is_habit(self, said: nlp.Statement) -> bool:
        """Return whether a statement flagged as a plan is a habit: *I like to read*, but not *I would like to read*."""
        first = predicate_of(said).split()[0]
        likes = [word for word in self.tree.words if word.lemma == first]
        return first in WORDS["likes"] and not any(
            aux.low in ("would", "'d") for aux in self.tree.children_of(likes, "aux")
        )

    def links(self, said: nlp.Statement) -> list[Link]:
        """Return the topics of a statement: by the table, or else by the words around its values."""
        listed = list(self._listed(said))
        framed = None if any(map(self.values, listed)) else framed_in(self, said)
        return [*listed, framed] if framed else listed

    def _listed(self, said: nlp.Statement) -> Iterator[Link]:
        subject, object, predicate = said.subject, said.object, predicate_of(said)
        if subject.person == "I" and subject.text.lower() not in MINE:
            yield from self._of_user(said)
        elif object.person == "I" and (found := SAYS.get(f"{predicate} me")):
            yield Link(found[0], subject, found[1])
        elif subject.of("I") and (found := SAYS.get(f"my {subject.head} {predicate} {object.preposition}")):
            yield Link(found[0], object, found[1])
        elif topic := self.noun(subject):
            if f"{predicate} {object.preposition}" in ("answer to", "go by") and TOPICS[topic].kind == "people":
                yield Link(topic, object)
            elif predicate in _CALLED and not object.preposition:
                sure = (
                    bool(object.names) or (subject.head == "name" and subject.owner) or TOPICS[topic].kind != "people"
                )
                if subject.names and subject.head not in ("name", ""):
                    return  # "my friends Ada and Bob, and my dog is called Rex"
                yield Link(topic, object if object.text and isinstance(said.triple.object, str) else None, bool(sure))
                yield from beside_name(self, said) if topic == NAME else ()
            elif TOPICS[topic].kind == "activity" and (verb := self.verb(said)):
                yield Link(topic, subject, value=self.span_of(verb.text, object))
        elif said.verb == "be" and (topic := self.noun(object)):
            yield Link(topic, subject if isinstance(said.triple.subject, str) else None, sure=topic != NAME)

    def _of_user(self, said: nlp.Statement) -> Iterator[Link]:
        predicate, object = predicate_of(said), said.object
        verb = self.verb(said)
        if verb is not None and verb.dep == "relcl" and not self.was_child:
            value = self._equated(said, verb)
            if value is None:
                return  # "the film that I like"
            said = replace(said, object=value)
            object = value
        if trade := trade_in(self, said):
            yield trade
            return
        if switched := switched_in(self, said):
            yield switched
            return
        has = self.has(said)
        if has and (topic := NOUNS.get(object.head, "")) and (said.negated or said.question):
            yield Link(topic, object if object.names else None)
        told = list(self._by_table(said, has=has))
        hobby = pursuit_in(self, said) if all(link.topic == "liking" or not link.sure for link in told) else None
        told = [*(being_in(self, said) if predicate == "be" else ()), *told]
        yield from [hobby] if hobby else told
        if not hobby and {"subject"} == {link.topic for link in told if self.values(link)}:  # "I do law at Leiden"
            yield from (Link("university", phrase) for phrase in said.phrases if phrase.preposition in ("at", "from"))

    def _dislikes(self, said: nlp.Statement) -> bool:
        """Return whether the user dislikes something: *I hate rain*, *I can't stand rain*."""
        verbs = WORDS["enduring"] if said.negated else WORDS["dislikes"]
        return said.subject.person == "I" and predicate_of(said) in verbs and bool(said.object.text)

    def _equated(self, said: nlp.Statement, verb: Word) -> Phrase | None:
        """Return the value for which the antecedent of a relative clause stands: *the firm I work for is Aldi*."""
        stranded = [word.low for word in self.tree.children(verb, "prep") if not self.tree.children(word)]
        for one in self.seen.statements:
            if one.verb == "be" and one.holds and one is not said:
                for side, other in ((one.object, one.subject), (one.subject, one.object)):
                    if side.text and side.text == said.object.text and other.text:
                        return replace(other, preposition=next(iter(stranded), ""))
        return None

    def _by_table(self, said: nlp.Statement, *, has: bool) -> Iterator[Link]:
        """Yield the topics that the table has for *live in* (verb, preposition) or *have a job at* (with an object)."""
        predicate, object = "like" if self._dislikes(said) else predicate_of(said), said.object
        child = self.was_child or any(one.preposition == "as" and one.head in WORDS["young"] for one in said.phrases)
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
            if not found and phrase.preposition in ("for", "in", "with") and said.verb not in WORDS["passing"] | {"be"}:
                found = ("club", False) if phrase.head in TOPICS["club"].nouns else None  # "I row for the club"
            if found and found[0] == "liking" and phrase.head in WORDS["liked"]:
                continue  # "I like a girl in my class"
            if phrase.text and found and self._word_before(phrase) not in WORDS["returning"]:
                topic = "childhood" if child and found[0] == "home" else found[0]
                place = next(
                    iter(said.phrases[said.phrases.index(phrase) + 1 :] if phrase in said.phrases else ()), phrase
                )
                inside = (
                    TOPICS[topic].kind == "place" and not phrase.names and place.preposition == "in" and place.names
                )
                yield Link(topic, place if inside else phrase, found[1])  # "a hospital in Pune"
                if (
                    topic == "childhood"
                    and self.words & {"born"}
                    and not any(one.verb in ("bear", "born") and one.object != object for one in self.seen.statements)
                ):
                    yield Link("birthplace", phrase)  # "I was born and raised in Dresden"

    def _word_before(self, phrase: Phrase) -> str:
        """Return the word before a phrase and its preposition: a verb that the parser may have mistaken for a noun."""
        pattern = rf"(\w+) {phrase.preposition} (?:an? |the )?{re.escape(phrase.text)}"
        found = re.search(pattern, self.tree.text, re.IGNORECASE) if phrase.preposition else None
        return found[1].lower() if found else ""


def _add(told: dict[str, tuple[str, ...]], topic: str, values: Iterable[str]) -> None:
    for value in values:
        one = "hobby" if topic == "liking" and is_gerund(value) else topic
        before = told.get(one, ())
        if value not in before and (TOPICS[one].many or not before):
            told[one] = (*before, value)
