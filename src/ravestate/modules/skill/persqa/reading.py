"""The facts that an utterance tells or asks for.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.

The tagger (a network) finds the values that the user states or denies. The statements of the analysis (`nlp.Statement`)
show what the user asks, and which topics lose all their values (*I quit my job*).
"""

from __future__ import annotations

import itertools
import re
from functools import cached_property

from ravestate.language.nonsense import is_nonsense
from ravestate.language.tagger import Tag, tagger
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.tree import Tree, Word

from .plain import plain_tags
from .topics import ASKS, ENDS, LASTING, NAME, NATIONS, NOUNS, NOW, TOPICS, WORDS, Fact, favourite
from .values import value_of
from .wording import Facts, alike, among, without

SURE = 0.5
"""If the tagger is less confident of a value than this, the value does not count."""
CLEAR = 0.9
"""If the tagger is at least this confident of a value, the value counts regardless of the agent's question."""
OPENING = 30
"""A name that the tagger does not find, but that follows words such as *my name is*, must start before this position in
the text."""
LONGEST = 1_000
"""If a text has more characters than this, the tagger does not read it."""
FEW = 2
"""If an answer has at most this many words, it is a value, even if the tagger finds none in it: *ludo*."""
MINE = frozenset(["mine", "ours"])
"""Subjects that stand for something of the user's: *mine is Ada*, after *which dog is yours?*."""
PEOPLE = frozenset(topic.name for topic in TOPICS.values() if topic.kind in ("people", "name"))
_UNUSUAL = re.compile(r"[^\w\s.,;:!?'’\"-]")
"""Characters that no word of English has. The tagger was not trained on them."""
_PARTLY = re.compile(r"(?:n['’]t|\bnot) (?:just|only|merely|simply)\b|\bbecause\b", re.IGNORECASE)
_JOINED = re.compile(r"[^.!?]*\band\b[^.!?]*", re.IGNORECASE)
"""If *and* stands between two values in one sentence, an unsure second value does not replace the first value."""
_SPEAKING = frozenset(("speak", "talk", "call", "be"))
_NAMING = frozenset(("call", "name", "christen", "baptise", "dub", "say", "use", "prefer", "be"))
"""Verbs with which users say their own name: *Ada speaking*, *just say Kim*."""
_REPORTING = frozenset(("say", "tell", "claim", "think", "believe"))
_OTHERS = frozenset(("it", "him", "her", "them"))
_PRONOUN = re.compile(r"\b(?:he|she|his|her|hers|him|its?)\b", re.IGNORECASE)


class Reader:
    """The values and topics in an utterance.

    Args:
        seen: The analysis of the utterance.
        asked: The topic of the agent's open question, or an empty string.
        person: The topic of the relative whom *he* or *his* means, or an empty string.
        known: The facts that were known before the utterance.
    """

    def __init__(self, seen: nlp.Analysis, asked: str = "", person: str = "", known: Facts | None = None) -> None:
        self.seen, self.tree, self.known, self.asked = seen, seen.tree, known or {}, asked
        self.words = {word.low for word in seen.tree.words}
        mine = (said.object for said in seen.statements if said.subject.person == "I" or said.object.of("I"))
        owned = (self.relative(object.head) for object in mine)
        self.person = person or next(filter(None, owned), "")

    # ---------------------------------------------------------------------------------- values

    @cached_property
    def tags(self) -> tuple[Tag, ...]:
        """The values that the utterance states or denies. Nonsense, such as *asdkjh qwe*, has none."""
        context = self.asked or (self.person if _PRONOUN.search(self.tree.text) else "")
        text = self.tree.text
        if len(self.seen.text) > LONGEST or is_nonsense(self.seen.text):
            return ()
        if not tagger().loaded:
            unsure = any(
                said.negated or said.hearsay or said.conditional or said.question for said in self.seen.statements
            )
            bare = self.asked if not (self.seen.yesno or self.seen.acts or self.seen.feelings) else ""
            return () if unsure else plain_tags(text, bare, self.seen)
        context = "favourite" if context.startswith("favourite") else context
        alone = tagger().tags(text)
        found = list(tagger().tags(text, context)) if context else list(alone)
        for number, tag in enumerate(found):  # "my name is Ada", after a question for the mother's name
            told = next((one for one in alone if one.start < tag.end and one.end > tag.start), None)
            found[number] = told if told is not None and told.score > CLEAR else tag
        if _UNUSUAL.search(text) and not any(tag.label == NAME for tag in found):  # "my name is 🦊"
            known = " ".join(_UNUSUAL.sub(" ", text).split())
            named = [tag for tag in tagger().tags(known) if tag.label == NAME]
            found += named or [tag for tag in plain_tags(text, "") if tag.label == NAME and tag.start < OPENING]
        return tuple(
            tag
            for tag in found
            if tag.score >= SURE
            and not self._is_contrasted(tag)
            and not (tag.negated and ((NOW - {"now"}) & self.words or _PARTLY.search(text)))  # "I'm not just a nurse"
            and (context or tag.text != text.strip(" .!?"))  # a bare word, such as "Hannover.", needs a question
            and not (self._describes_work(tag) or self._is_over(tag) or self._is_hearsay(tag) or self._is_anothers(tag))
        )

    def facts(self) -> list[Fact]:
        """Return the facts that the user states or denies."""
        told: dict[str, tuple[str, ...]] = {}
        clear: dict[str, int] = {}  # topic → the position in the text after its last clear value
        gone = self._ended()
        for tag in self.tags:
            topic = self._topic(tag)
            value = self.value(topic, self._whole(tag)) if topic else None
            if value and tag.negated:
                known = self.known.get(topic, ())
                fits = alike if TOPICS[topic].kind == "activity" else among
                gone[topic] = gone.get(topic, ()) + (tuple(one for one in known if fits(one, (value,))) or (value,))
            elif value and (
                tag.score >= CLEAR or not _JOINED.fullmatch(self.tree.text[clear.get(topic, tag.start) : tag.start])
            ):
                clear |= {topic: tag.end} if tag.score >= CLEAR and not TOPICS[topic].many else {}
                for other, values in self.known.items():  # "Rex is a dog", if Rex was taken for a cat
                    both = {TOPICS[other].type, TOPICS[topic].type} == {"Animal"} and other != topic
                    gone |= {other: (value,)} if both and among(value, values) else {}
                before = told.get(topic, ())
                told[topic] = before if among(value, before) else (*before, value) if TOPICS[topic].many else (value,)
        for one in self.seen.contrasts:  # "Nora is my brother's wife, not my sister"
            topic = self.noun(one.wrong)
            told.pop(topic if topic in PEOPLE else "", None)
            named = [name for name in self.known.get(topic, ()) if name.lower() in self.tree.text.lower()]
            if topic in PEOPLE and named:
                gone[topic] = gone.get(topic, ()) + tuple(named)
        told = {topic: without(values, gone.get(topic, ())) for topic, values in told.items()}
        struck = [Fact(topic, values, gone=True) for topic, values in gone.items() if values or not told.get(topic)]
        return [*(Fact(topic, values) for topic, values in told.items() if values), *struck]

    def names(self) -> dict[str, tuple[str, ...]]:
        """Return the names of relatives, friends and pets, by topic."""
        return {
            fact.topic: fact.values for fact in self.facts() if TOPICS[fact.topic].kind == "people" and not fact.gone
        }

    def covers(self, said: nlp.Statement) -> bool:
        """Return whether a statement tells the value of a topic.

        If not, it may be a *free statement*, which belongs to no topic: *Jonas plays the violin*.
        """
        parts = [part.text.lower() for part in (said.object, *said.phrases) if part.text]
        parts += [self.span(said).lower()]
        values = (tag.text.lower() for tag in self.tags if tag.label not in PEOPLE)
        return any(value in part or (part and part in value) for value in values for part in parts)

    def value(self, topic: str, text: str) -> str | None:
        """Return some words as a value of a topic, in memory's spelling; None if they cannot be a value.

        Nonsense is no answer to the agent's question: *asdkjh*.
        """
        if topic == self.asked and is_nonsense(text):
            return None
        found = value_of(text, TOPICS[topic], self.seen)
        return NATIONS.get(found.lower(), found) if found and topic == "origin" else found

    def values_in(self, text: str, topic: str) -> list[str]:
        """Return the values of a topic in a text that answers a question about this topic."""
        text = text if text.endswith((".", "!", "?")) else f"{text}."
        found = tagger().tags(text, topic) if tagger().loaded else plain_tags(text, topic)
        texts = [self._whole(tag) for tag in found if tag.label == topic and _holds(tag)]
        bare = text.strip(" .!?")
        if not texts and 0 < len(bare.split()) <= FEW and not any(tag.negated for tag in found):  # "no, ludo"
            texts = [bare]
        return [value for one in texts if (value := self.value(topic, one))]

    def _whole(self, tag: Tag) -> str:
        """Return the words of a tag, with the article of a place or an organisation: *the choir*.

        The name in *the name's Bond, James Bond* is *James Bond*."""
        text = self.tree.text
        full = re.match(rf",\s+((?:[\w'’-]+\s+){{1,2}}{re.escape(tag.text)})(?!\w)", text[tag.end :])
        if tag.label == NAME and full:
            return full[1]
        found = re.search(r"\b(?:the|an?) $", text[: tag.start], re.IGNORECASE)
        articled = tag.label in TOPICS and TOPICS[tag.label].kind in ("place", "organisation")
        return f"{found[0]}{tag.text}" if found and articled and text[tag.start : tag.end] == tag.text else tag.text

    def _topic(self, tag: Tag) -> str:
        """Return the topic of a value; empty if it is the user's favourite of an unknown kind."""
        if tag.label != "favourite":
            return tag.label
        if self.asked.startswith("favourite"):
            return self.asked
        words = self.tree.words
        nouns: list[str] = []
        for word in words:
            if word.low in ("favourite", "favorite", "fave", "fav"):
                after = itertools.takewhile(lambda one: one.pos in ("NOUN", "ADJ", "PROPN"), words[word.index + 1 :])
                nouns.append(" ".join(one.low for one in after))
        return favourite(f"favourite {nouns[-1]}") if nouns and nouns[-1] else ""

    def _describes_work(self, tag: Tag) -> bool:
        """Return whether words describe a job instead of naming it: *drive a bus*.

        An utterance with such words is a free statement, and tells no occupation.
        """
        first = next((word for word in self.tree.words if word.start <= tag.start < word.end), None)
        return (
            tag.label == "occupation"
            and first is not None
            and first.tag in ("VB", "VBP", "VBD", "VBZ")
            and " " in tag.text
        )

    def _is_over(self, tag: Tag) -> bool:
        """Return whether a value no longer holds, because its verb (such as *live*) is in the past tense: *I lived in Rome*."""
        if tag.negated or tag.label in LASTING or tag.label in PEOPLE:
            return False
        for said in self.seen.statements:
            parts = (part.text for part in (said.object, *said.phrases) if part.text)
            if (
                any(part in tag.text or tag.text in part for part in parts)
                and said.past
                and said.verb in WORDS["states"]
            ):
                return not said.negated
        return False

    def _is_hearsay(self, tag: Tag) -> bool:
        """Return whether other people say a value about the user: *people say I am from Spain*."""
        if tag.label == NAME or not any(
            one.verb in _REPORTING for one in self.seen.statements if one.subject.person != "I"
        ):
            return False
        mine = (said for said in self.seen.statements if said.hearsay and said.subject.person == "I")
        return any(tag.text in self.span(said) for said in mine)

    def _is_contrasted(self, tag: Tag) -> bool:
        """Return whether a value replaces a known one: *not Leeds but Leipzig*.

        Its topic is then the topic of the known value, not the tagger's label.
        """
        verbs = any(said.verb != "be" for said in self.seen.statements)
        known = [value for values in self.known.values() for value in values]
        pairs = [one for one in self.seen.contrasts if one.right.text == tag.text]
        return not verbs and any(among(one.wrong.text, known) for one in pairs)

    def _is_anothers(self, tag: Tag) -> bool:
        """Return whether a name or a relative is somebody else's.

        Examples: *Zosia waits for me*, *I named it Kevin*, *he has a new girlfriend called Tamara*.
        """
        if tag.label == NAME and any(map(self._names_another, self._words_of(tag))):
            return True
        having = (said for said in self.seen.statements if tag.label == self.relative(said.object.head))
        return any(said.subject.text.lower() in ("he", "she", "they") for said in having)

    def _words_of(self, tag: Tag) -> list[Word]:
        return [word for word in self.tree.words if tag.start <= word.start < tag.end]

    def _names_another(self, word: Word) -> bool:
        """Return whether a name is somebody else's.

        Such a name is given to *it* or *her*, follows *me and*, or is the subject or object of a verb. Verbs with which
        users say their own name, such as *call*, are exceptions.
        """
        head = self.tree.head(word)
        if word.dep == "conj":
            return head.low in ("me", "i", "us")
        if word.dep == "nsubj":
            return head.pos == "VERB" and head.lemma not in _SPEAKING
        if word.dep == "dobj":
            return head.lemma not in _NAMING
        return word.dep == "oprd" and any(other.low in _OTHERS for other in self.tree.children(head, "dobj", "nsubj"))

    def _ended(self) -> dict[str, tuple[str, ...]]:
        """Return the topics that lose all their values: *I quit my job*, *I have no hobbies*."""
        ended: dict[str, tuple[str, ...]] = {}
        text = self.tree.text.lower()
        for said in self.seen.statements:
            whole = (
                f"{'not ' * said.negated}{predicate_of(said)} {said.object.head or said.object.text.lower()}".strip()
            )
            holds = not (said.hearsay or said.conditional or said.question or said.plan)
            if said.subject.person == "I" and holds and (topic := ENDS.get(whole)) and not self._tagged(topic):
                ended[topic] = ()
            noun = said.object.text.lower().split()[-1:]
            denied = noun and re.search(
                rf"(?:\b(?:no|any)|n[o'’]t (?:have|got|own) an?) (?:\w+ )?{re.escape(noun[0])}\b", text
            )
            topic = NOUNS.get(said.object.head, "") if denied and said.negated and not said.object.names else ""
            if topic and holds and self.has(said) and not self._tagged(topic):
                ended[topic] = ()
        return ended

    def _tagged(self, topic: str) -> bool:
        return any(tag.label == topic for tag in self.tags)

    # ---------------------------------------------------------------------------------- questions

    def asks(self) -> Fact | None:
        """Return the fact that the user asks for. Its values are those to confirm or deny: *do I live in Ulm*."""
        kinds = nlp.QuestionWord
        for said in self.seen.statements:
            if not said.question or said.conditional:
                continue
            parts = (said.triple.object, said.triple.subject, self.seen.question)
            unknown = next((part for part in parts if isinstance(part, kinds) and part != kinds.YES_NO), None)
            mine = said.subject.person == "I" and said.subject.text.lower() not in MINE
            if unknown is not None and mine:
                asked = f"{predicate_of(said)} {unknown.name}"
                keys = (*(f"{asked} {phrase.head}" for phrase in said.phrases), asked)
                keys = (*keys, f"know {asked}") if self.words & {"know", "remember"} else keys
                if topic := self._asked_noun(said) or next(filter(None, map(ASKS.get, keys)), ""):
                    return Fact(topic)
            if unknown is None and (asked := self._confirmed(said)):
                return asked
            named = said.verb in ("be", "call", "name", "spell")
            if topic := (self.noun(said.subject) if named else "") or (
                self.noun(said.object) if said.verb == "be" or self.has(said) else ""
            ):
                wanted = unknown in (None, kinds.PERSON, kinds.OBJECT, kinds.PLACE, kinds.AMOUNT) or said.verb == "call"
                if wanted and (unknown != kinds.AMOUNT or topic == "age"):
                    return Fact(topic)
            if unknown is None and self.has(said) and (topic := NOUNS.get(said.object.head, "")):
                return Fact(topic)  # "do I have a sister"
        return None

    def _confirmed(self, said: nlp.Statement) -> Fact | None:
        """Return the fact that a yes-no question asks about.

        To find it, turn the question into a statement, and tag this statement.
        """
        found = _INVERTED.search(self.tree.text)
        if found is None or not (said.subject.person == "I" or said.subject.of("I")):
            return None
        verb = "" if found[1].lower() in ("do", "did") else f" {found[1].lower()}"
        text = f"{found[2]}{verb} {found[3]}."
        for tag in tagger().tags(text) if tagger().loaded else ():
            topic = self._topic(tag)
            if topic and _holds(tag) and (value := self.value(topic, tag.text)):
                return Fact(topic, (value,))
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

    # ---------------------------------------------------------------------------------- phrases

    def noun(self, phrase: Phrase) -> str:
        """Return the topic of *my job*, *my sister's name*, *my favourite food*; empty for other phrases."""
        owner = phrase.owner
        if phrase.text.lower() in MINE:
            return self.asked
        if phrase.text.lower() == "name":  # "name is Ada, the name's Ada"
            return NAME
        theirs = owner and owner.text.lower() in ("his", "her") and phrase.head == "name"
        if theirs or phrase.text.lower() in ("he", "she"):
            return self.person
        if (bare := NOUNS.get((owner or phrase).text.lower())) in ("mother", "father") and phrase.head.lower() in (
            "name",
            "",
            phrase.text.lower(),
        ):
            return bare  # "mum's name is Ann"
        if owner is None or not phrase.of("I") or is_former(phrase.text):
            return ""
        if self.relative(phrase.head) and (owner.person != "I" or self._has_owner(phrase)):
            return ""  # "my friend's dog"
        if (phrase.head == "name" and owner.person != "I") or (phrase.head == "one" and owner.owner is not None):
            return self.noun(owner)  # "my sister's name, one of my hobbies"
        low = phrase.text.lower()
        if phrase.head == "name" and (relative := self.relative(low.split()[-2].removesuffix("s"))):
            return relative  # "my dogs name"
        topic = NOUNS.get(" ".join(low.split()[-2:])) or NOUNS.get(phrase.head, "")
        best = re.search(r"\bfavou?rite .+", low)
        if best and phrase.head[:3] in best[0] and topic != "hobby":
            return favourite(re.sub(r"\w+$", phrase.head, best[0]) if best[0].endswith(f"{phrase.head}s") else best[0])
        return topic

    def _has_owner(self, phrase: Phrase) -> bool:
        words = [word for word in self.tree.words if word.lemma == phrase.head and word.text in phrase.text]
        return any(owner_before(word, self.tree) for word in words)

    def has(self, said: nlp.Statement) -> bool:
        """Return whether the user says that they have something: *I have*, *I've got*."""
        got = said.verb == "get" and any(word.low == "got" for word in self.tree.words)
        return said.subject.person == "I" and (said.verb in ("have", "own") or got)

    def relative(self, noun: str) -> str:
        """Return the topic of a relative, a friend or a pet; empty for other nouns."""
        topic = NOUNS.get(noun, "")
        return topic if topic and TOPICS[topic].kind == "people" else ""

    def verb(self, said: nlp.Statement) -> Word | None:
        """Return the verb of a statement in the tree."""
        last = said.triple.predicate.split()[-1]
        verbs = [word for word in self.tree.words if word.low == last or word.lemma == said.verb]
        return min(verbs, key=lambda word: word.pos not in ("VERB", "AUX"), default=None)

    def is_denied(self, said: nlp.Statement) -> bool:
        """Return whether a clause that governs a statement denies it: *it's not like I left*, *it's not true that I left*."""
        verb = self.verb(said)
        marks = [] if verb is None else [word.low for word in self.tree.children(verb, "mark")]
        if verb is None or verb.dep not in ("advcl", "ccomp", "acl") or not {"like", "that"}.intersection(marks):
            return False
        above = next((word for word in self.tree.ancestors(verb) if word.lemma in ("be", "'s")), None)
        return above is not None and bool(self.tree.children(above, "neg"))

    def written(self, phrase: Phrase) -> str:
        """Return a phrase with its article, as in the utterance."""
        inner = r"\s+(?:(?:the|an?)\s+)?".join(map(re.escape, phrase.text.split()))
        articles = r"(?:(?:the|an?|our|this|that|these|those)\s+)?"
        name = r"(?:-[\w-]+|\s&\s\w+|\s(?:am|an der|upon|de|del)\s\w+)*"  # "Stoke-on-Trent, Frankfurt am Main"
        found = re.search(rf"(?<![\w']){articles}{inner}(?!\w){name}", self.tree.text, re.IGNORECASE)
        return found[0] if found else phrase.name or phrase.text

    def span(self, said: nlp.Statement) -> str:
        """Return the last verb of a statement, its object, and the words between them."""
        verb = self.verb(said)
        end = rf"(?:.{{0,40}}?{re.escape(said.object.text)})?"
        found = re.search(rf"\b{re.escape(verb.low)}\w*\b{end}", self.tree.text, re.IGNORECASE) if verb else None
        return found[0] if found else ""


_INVERTED = re.compile(
    r"\b(do|did|am|was|have|are|is) (i|we|(?:my|our) (?:favou?rite )?\w+(?:'s name| name)?) ([^?]+)\?", re.IGNORECASE
)
"""A yes-no question about the user: the auxiliary, the subject and the rest."""


def _holds(tag: Tag) -> bool:
    """Return whether a value is sure enough, and not denied."""
    return not tag.negated and tag.score >= SURE


def predicate_of(said: nlp.Statement) -> str:
    """Return the predicate without *not*, and without verbs of beginning or continuing: *work* for *start to work*."""
    words = said.triple.predicate.removeprefix("not ").split()
    while len(words) > 1 and (words[0] in WORDS["beginning"] or words[:2] == ["end", "up"]):
        first = 2 if words[0] == "end" or words[1] == "to" else 1
        if len(words) == first:
            break  # "where did I end up"
        del words[:first]
        words[0] = said.verb if len(words) == 1 or words[0].endswith("ing") else words[0]
    return " ".join(words)


def is_former(words: str) -> bool:
    """Return whether words are about somebody or something that is not the user's now: *my ex wife*."""
    return bool(WORDS["former"] & set(re.split(r"\W", words.lower())))


def owner_before(word: Word, tree: Tree) -> Word | None:
    """Return the person before a noun, to whom it belongs: *friend*, in *my friend's cat*, *my friends cat*."""
    for owner in tree.children(word, "poss", "compound"):
        if owner.pos in ("NOUN", "PROPN") and (owner.dep == "poss" or owner.tag == "NNS"):
            return owner
    return None
