"""The thread of a talk: the latest questions with their answers, and later questions completed from them.

A follow-up has several readings: *when was he born?* may mean anybody in view. `readings` yields them in order of
likelihood, and the documents decide between them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.tree import Tree, Word

from .answering import Answer
from .lexicon import words_of
from .question import FINITE, WH, Parse, is_name, parse

NUMBERS = ("DATE", "TIME", "CARDINAL", "QUANTITY", "MONEY", "PERCENT", "ORDINAL")
"""The labels of entities that are no names."""
PLACES = ("GPE", "LOC", "FAC")
LONGEST = 200
"""Characters of a question that may refer to another."""
KEPT = 6
"""The number of questions that stay in view."""
REMEMBERED = 120.0
"""Seconds for which later questions may refer to one."""
LESS = -0.4
"""The logarithm of odds that each reading loses to the one before."""
FAR = -5.0
"""The same for *she* as a thing, such as a ship, with a person in view."""
SEXES = {"he": "he", "him": "he", "his": "he", "she": "she", "her": "she", "hers": "she"}
PRONOUNS = frozenset((*SEXES, *["it", "its", "they", "them", "their", "there", "this", "that"]))
_ONES = ("one", "ones", "former", "latter")
_PLACES_IN_LIST = {
    "first": 0,
    "second": 1,
    "third": 2,
    "fourth": 3,
    "fifth": 4,
    "sixth": 5,
    "last": -1,
    "latter": -1,
    "former": -2,
}
_OWN = ("det", "amod", "compound", "nummod", "poss", "nmod", "quantmod")


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that a question or an answer names."""

    text: str
    label: str
    """The label of the entity; ``NAME`` or ``TITLE`` for other names, empty for common nouns."""

    @property
    def is_person(self) -> bool:
        """Whether it is a person."""
        return self.label == "PERSON"

    @property
    def is_name(self) -> bool:
        """Whether it has a name of its own."""
        return self.label not in ("", *NUMBERS)


@dataclass(frozen=True, slots=True)
class Turn:
    """A question with its answer, in a form that can be understood alone."""

    question: str
    answer: str
    title: str
    """The title of the document with the answer; empty for a sum."""
    at: float
    """Its time, in seconds since the context began."""
    asked: tuple[Thing, ...] = ()
    """The things in the question, most likely first."""
    told: tuple[Thing, ...] = ()
    """The things that only the answer names, most likely first."""
    items: tuple[str, ...] = ()
    """The members of a list in the answer."""
    sexes: tuple[tuple[str, str], ...] = ()
    """Names with their pronouns: ``he`` or ``she``."""
    source: str = ""
    confidence: float = 1.0
    defines: bool = False
    """Whether the question only asks for its subject: *who is Clara Venn?*. A pronoun then means the subject."""

    @property
    def subject(self) -> str:
        """The name that the question is about; empty without one."""
        return next((thing.text for thing in self.asked if thing.is_name), "")


@dataclass(frozen=True, slots=True)
class Reading:
    """A complete question that an utterance may stand for."""

    text: str
    prior: float = 0.0
    """How likely it is before the documents are asked, as a logarithm of odds."""
    about: str = ""
    """Its subject, where the text does not name it; only the documents of the thread count then."""
    sexes: tuple[tuple[str, str], ...] = ()


def turn_of(asked: Parse, found: Answer, at: float, sexes: tuple[tuple[str, str], ...] = ()) -> Turn:
    """Return the turn of a complete question and its answer."""
    answer, title = found.text, found.title
    told, words = parse(answer), set(asked.text.lower().split())
    things = [Thing(title, thing.label or "TITLE") if _same(thing.text, title) else thing for thing in things_of(asked)]
    things = [thing for thing in things if thing.label not in ("ORDINAL", "CARDINAL")]
    if (
        title
        and title.lower() in f"{asked.tree.text} {answer}".lower()
        and not any(_same(t.text, title) for t in things)
    ):
        things.append(Thing(title, next((t.label for t in things if t.is_name and t.text in title), "TITLE")))
    named = set(title.lower().split())
    things = [t for t in things if _same(t.text, title) or not named.issuperset(t.text.lower().split())]
    things.sort(key=lambda thing: not thing.is_name)
    defines = bool(title) and len(things) == 1 and _same(things[0].text, title) and asked.kind is QuestionWord.PERSON
    defines = defines and any(word.lemma == "be" for word in asked.asked)
    new = [t for t in things_of(told) if not _same(t.text, title) and not words.issuperset(t.text.lower().split())]
    if asked.kind is QuestionWord.PERSON:
        if not any(thing.is_person for thing in new):
            name = next((thing for thing in new if thing.is_name), None)
            new = [Thing(thing.text, "PERSON") if thing is name else thing for thing in new]
        known = [sex for sex in ("he", "she") if not words_of(sex).isdisjoint(words)]
        sexes = (*sexes, *((thing.text, sex) for thing in new if thing.is_person for sex in known))
    items = max(_lists(told.tree), key=len, default=())
    question = asked.text.rstrip("?")
    return Turn(
        question, answer, title, at, tuple(things), tuple(new), items, sexes, found.source, found.confidence, defines
    )


def overheard(said: str, at: float) -> Turn:
    """Return a turn of what the agent said by itself, for the names in it."""
    return Turn("", said, "", at, told=tuple(thing for thing in things_of(parse(said)) if thing.is_name))


def things_of(seen: Parse) -> list[Thing]:
    """Return the noun phrases of a text; *the mayor of Tarm* also as a whole."""
    found: dict[str, Thing] = {}
    for word in seen.tree.words:
        own = phrase_of(seen.tree, word) if _is_noun(word) else []
        if not own or any(other.tag in WH for other in own):
            continue
        entity = next((e for e in seen.entities if e.start < word.end and word.start < e.end), None)
        label = entity.label if entity else ""
        text = entity.text.removesuffix("'s") if entity and label == "PERSON" else seen.tree.phrase(own)
        found.setdefault(text.lower(), Thing(text, label or ("NAME" if word.pos == "PROPN" else "")))
        for of in seen.tree.children(word, "prep"):
            if of.low == "of":
                text = seen.tree.phrase([*own, *seen.tree.subtree(of)])
                found.setdefault(text.lower(), Thing(text, ""))
    return list(found.values())


def _is_noun(word: Word) -> bool:
    return word.pos in ("NOUN", "PROPN", "X") and word.dep not in ("compound", "nmod", "amod")


def phrase_of(tree: Tree, head: Word) -> list[Word]:
    """Return a noun with its own words to the left."""
    left = [child for child in tree.children(head, *_OWN) if child.index < head.index]
    return [*(word for child in left for word in tree.subtree(child)), head]


def _same(one: str, other: str) -> bool:
    return one.lower().removeprefix("the ") == other.lower().removeprefix("the ")


def _lists(tree: Tree) -> Iterator[tuple[str, ...]]:
    """Yield the members of each enumeration."""
    for word in tree.words:
        members = [word]
        while nexts := tree.children(members[-1], "conj"):
            members.append(nexts[0])
        if len(members) > 2 and tree.children(word, "nummod"):  # two moons, Ibo and Usk
            members = members[1:]
        if len(members) > 1 and _is_noun(word) and word.dep != "conj":
            yield tuple(tree.phrase(phrase_of(tree, member)) for member in members)


# ------------------------------------------------------------------------------------------------ readings


def readings(seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str] = lambda _: "") -> list[Reading]:
    """Return the questions that an utterance may stand for; none if it refers to something that is not in view.

    Args:
        seen: The utterance.
        thread: The latest questions, oldest first.
        titled: A function from a name in any case to the title of a document about it; empty if there is none.
    """
    if not seen.asked or len(seen.text) > LONGEST:
        return [Reading(seen.text)]
    if not thread:
        return [] if _leans(seen) else [Reading(seen.text)]
    found: dict[str, Reading] = {}
    for reading in _Follow(seen, thread, titled).readings():
        found.setdefault(f"{reading.about} {reading.text}".lower().strip("? "), reading)
    return list(found.values())


def _leans(seen: Parse) -> bool:
    """Return whether an utterance cannot be understood alone."""
    words = [word for word in seen.asked if word.pos != "PUNCT"]
    content = ["NOUN", "PROPN", "VERB", "NUM", "X"]
    if not any(refers(word, words) or word.low in _ONES for word in words):
        content.append("ADJ")
    bound = next((word.index for word in words if word.pos in ("NOUN", "PROPN")), len(seen.tree.words))
    return (
        not any(word.pos in content and word.low not in _ONES for word in words)
        or any(word.tag == "PRP$" and word.index < bound for word in words)
        or (words[0].pos == "CCONJ" and not seen.is_finite)
    )


def refers(word: Word, words: Sequence[Word]) -> bool:
    """Return whether a word is a pronoun for something outside its sentence."""
    if word.low not in PRONOUNS:
        return False
    if word.low == "there":
        return word.dep != "expl" and word.tag != "EX"
    if word.low in ("that", "this"):
        return word.dep in ("nsubj", "nsubjpass", "pobj", "dobj", "attr", "ROOT") and word.tag == "DT"
    subjects = ("nsubj", "nsubjpass")  # how do plants make their food
    return not any(w.pos in ("NOUN", "PROPN") and w.index < word.index and w.dep in subjects for w in words)


def referents(pronoun: Word, thread: Sequence[Turn]) -> list[Thing]:
    """Return the things that a pronoun may stand for, most likely first."""
    sex = SEXES.get(pronoun.low)
    known = {name: SEXES[said] for turn in thread for name, said in turn.sexes}
    found: dict[str, Thing] = {}
    for turn in reversed(thread[-2:]):
        told_first = not turn.defines and (
            sex or pronoun.low == "there" or turn.question.lower().startswith(("what ", "which "))
        )
        things = [*turn.told, *turn.asked] if told_first else [*turn.asked, *turn.told]
        for rank in (0, 1, 2):
            for thing in things:
                unlikely = _unlikely(pronoun.low, sex, thing, known)
                if unlikely == rank or (turn.defines and thing in turn.asked and unlikely < 3):
                    found.setdefault(thing.text.lower(), thing)
    return list(found.values())[:6]


def _unlikely(pronoun: str, sex: str | None, thing: Thing, known: Mapping[str, str]) -> int:
    """Return how unlikely a thing is for a pronoun, from 0; 3 is out of the question."""
    if sex:
        return 3 if known.get(thing.text, sex) != sex else 0 if thing.is_person else 1 if thing.is_name else 2
    if thing.label in NUMBERS:
        return 3
    if pronoun == "there":
        return 0 if thing.label in PLACES else 1 if thing.is_name and not thing.is_person else 2
    if pronoun in ("it", "its"):
        return 2 if thing.is_person else 0 if thing.label else 1
    return 0 if thing.label else 1


def correction(seen: Parse) -> list[Word]:
    """Return the words for what was really meant: *I meant Mount Olin*."""
    root = next((word for word in seen.asked if word.lemma == "mean" and word.head == word.index), None)
    if root is None or not any(word.low == "i" for word in seen.tree.children(root, "nsubj")):
        return []
    things = [word for word in seen.tree.children(root, "dobj", "attr", "oprd") if _is_noun(word)]
    return seen.tree.subtree(things[0]) if things else []


class _Follow:
    """An utterance after others."""

    def __init__(self, seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str]) -> None:
        self.seen, self.tree, self.thread = seen, seen.tree, thread
        self.last = thread[-1]
        self.before = next((turn for turn in reversed(thread) if turn.question), self.last)
        words = said = [word for word in seen.asked if word.pos != "PUNCT"]
        while words and (
            words[0].pos == "CCONJ" or [word.low for word in words[:2]] in (["what", "about"], ["how", "about"])
        ):
            words = words[1 if words[0].pos == "CCONJ" else 2 :]
        self.words, self.leads = words, len(words) < len(said)
        self.text = self.tree.phrase(words)
        self.pronouns = [word for word in words if refers(word, words)]
        heads = [self.tree.phrase(phrase_of(self.tree, word)) for word in words if _is_noun(word)]
        self.named = any(is_name(seen, word) for word in words) or any(map(titled, (self.text, *heads)))
        self.names = [thing for thing in (*self.last.asked, *self.last.told) if thing.is_name]

    def readings(self) -> Iterator[Reading]:
        """Yield the readings, most likely first."""
        one = next(
            (word for word in self.words if word.low in _ONES and word.pos in ("NUM", "NOUN", "PRON", "ADJ")), None
        )
        if meant := correction(self.seen):
            yield from self._swapped(self.tree.phrase(meant), named=True)
        elif one is not None:
            yield from self._chosen(one)
        elif self.words and not any(word.tag in FINITE for word in self.words):
            yield from self._fragment()
        elif self.pronouns:
            yield from self._resolved()
            if any(w.low == "it" for w in self.pronouns) and any(
                w.pos in ("NOUN", "PROPN", "VERB") for w in self.words
            ):
                yield Reading(f"{self.text}?", -1.0)  # when did it start to rain
        elif self.words:
            if not self.named:
                for rank, thing in enumerate(self.names):  # who was on board
                    yield Reading(f"{self.text}?", 0.8 + LESS * rank, about=thing.text)
            yield Reading(f"{self.text}?", 0.0 if self.named or self.leads else -1.0)

    def _resolved(self) -> Iterator[Reading]:
        pronoun = self.pronouns[0].low
        person = pronoun in SEXES and not self.last.defines and any(thing.is_person for thing in self.last.told)
        for rank, thing in enumerate(referents(self.pronouns[0], self.thread)):
            sexes = ((thing.text, pronoun),) if pronoun in SEXES else ()
            far = FAR if person and not thing.is_person else 0.0
            yield Reading(self._with(self.words, thing.text), LESS * rank + far, sexes=sexes)

    def _with(self, words: Sequence[Word], thing: str, instead: Sequence[Word] = ()) -> str:
        """Return words as a question, with a thing in place of the pronouns and of the phrase `instead`."""
        parts: list[str] = []
        for word in words:
            if word in instead:
                parts += [thing] if word is instead[0] else []
            elif word in self.pronouns:
                parts.append(f"{thing}'s" if word.tag == "PRP$" else f"in {thing}" if word.low == "there" else thing)
            else:
                parts.append(word.text)
        return " ".join(parts).replace(" 's", "'s").replace(" n't", "n't").strip(" ?!.,") + "?"

    def _chosen(self, one: Word) -> Iterator[Reading]:
        """Yield the readings of *the first one* and *the other one*: members of a list, or earlier subjects."""
        own = [word for word in phrase_of(self.tree, one) if word in self.words]
        before = self.tree.before(own[0])
        if before is not None and before.low == "the":
            own = [before, *own]
        rest = [word for word in self.words if word not in own]
        if any(word.tag in WH for word in rest) and rest[0].index > one.index:  # the first one, who climbed it?
            words = rest
        else:
            words = self.words if any(word.tag in FINITE for word in rest) else []
        low = {word.low for word in own}
        subjects = list(dict.fromkeys(turn.asked[0].text for turn in self.thread if turn.asked))
        for group in (*(list(turn.items) for turn in reversed(self.thread[-2:]) if turn.items), subjects):
            chosen = group[-2::-1] if "other" in low else []
            for rank, place in _PLACES_IN_LIST.items():
                if rank in low and -len(group) <= place < len(group):
                    chosen.append(group[place])
            for thing in chosen:
                if words:
                    yield Reading(self._with(words, thing, own))
                else:
                    yield from self._swapped(thing, named=True)

    def _fragment(self) -> Iterator[Reading]:
        """Yield the readings of an utterance without a verb: *and when?*, *and its captain?*, *and Spain?*."""
        alone = f"{self.text}?" if self.seen.kind is not None else self.text
        first, last = self.words[0], self.words[-1]
        if self.pronouns:
            yield from self._resolved()
        elif any(word.tag in WH for word in self.words):
            yield from self._asked_anew()
        elif not self.named and last.tag in ("JJS", "JJR", "JJ", "RBS", "RB", "CD"):
            yield from self._ranked()
        elif first.pos in ("ADP", "SCONJ"):
            yield from self._swapped(self.tree.phrase(self.words[1:]), named=self.named, after=first.low)
            yield Reading(f"{self.before.question} {self.text}?", LESS)
        else:
            if self.named:
                yield from ([] if self.leads else [Reading(alone)])
                yield from self._swapped(self.text, named=True)
            for rank, thing in enumerate(self.names):
                yield Reading(f"{self.text} of {thing.text}?", LESS * rank)
            if not self.named:
                yield from self._swapped(self.text, named=False)
                yield from ([] if self.leads else [Reading(alone, -1.0)])

    def _swapped(self, new: str, *, named: bool, after: str = "") -> Iterator[Reading]:
        """Yield the question before about something else, first in place of a thing that follows the word `after`."""
        question = self.before.question
        olds = [thing.text for thing in self.before.asked if thing.is_name == named]
        olds.sort(key=lambda old: f"{after} {old}".lower() not in question.lower())
        for rank, old in enumerate(olds):
            at = question.lower().find(old.lower())
            if at >= 0:
                yield Reading(f"{question[:at]}{new}{question[at + len(old) :]}?", LESS * rank)

    def _asked_anew(self) -> Iterator[Reading]:
        """Yield the question before with another question word."""
        words = [word for word in parse(self.before.question).tree.words if word.pos != "PUNCT"]
        asks = next((place for place, word in enumerate(words) if word.tag in WH), None)
        if asks is not None:
            verb = next((p for p, word in enumerate(words) if p > asks and word.pos in ("AUX", "VERB")), asks + 1)
            yield Reading(" ".join([self.text, *(word.text for word in words[verb:])]).replace(" 's", "'s") + "?")

    def _ranked(self) -> Iterator[Reading]:
        """Yield the question before with another rank: *and the second highest?*."""
        words = parse(self.before.question).tree.words
        ranks = [
            place for place, word in enumerate(words) if word.tag in ("JJS", "RBS") or word.low in words_of("ranks")
        ]
        if ranks:
            left = [word.text for word in words[: ranks[0]]]
            left = left[:-1] if left[-1:] == ["the"] and self.text.lower().startswith("the ") else left
            yield Reading(
                " ".join([*left, self.text, *(word.text for word in words[ranks[-1] + 1 :])]).replace(" 's", "'s") + "?"
            )
