"""The thread of a conversation: the latest questions with their answers. A follow-up is a question that refers to it.

A follow-up has several readings: in *when was he born?*, *he* may be any man in the last two turns. `readings` returns
them roughly in order of likelihood, and the documents decide between them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.questions import FINITE, WH
from ravestate.modules.meta.nlp.tree import Tree, Word

from .answering import Answer
from .lexicon import words_of
from .question import PRONOUNS, SEXES, Parse, is_name, parse

NUMBERS = ("DATE", "TIME", "CARDINAL", "QUANTITY", "MONEY", "PERCENT", "ORDINAL")
"""The labels of entities that are numbers, not names."""
LONGEST = 200
"""The maximum number of characters of a question that may refer to another question."""
KEPT = 6
"""The maximum number of questions in the thread."""
REMEMBERED = 120.0
"""Later questions may refer to a question for this many seconds."""
LESS = -0.15
"""The usual change of the log odds from one reading to the next."""
_ONES = ("one", "ones", "former", "latter")
_RANKS = {name: place for place, name in enumerate(["first", "second", "third", "fourth", "fifth", "sixth"])} | {
    "last": -1, "latter": -1, "former": -2,
}  # fmt: skip
_OWN = ("det", "amod", "compound", "nummod", "poss", "nmod", "quantmod")


@dataclass(frozen=True, slots=True)
class Thing:
    """A person, place or other thing that a question or an answer names."""

    text: str
    label: str
    """The label of the entity; ``NAME`` for other names, ``TITLE`` for a document's title; otherwise empty."""

    @property
    def is_person(self) -> bool:
        """Whether the thing is a person."""
        return self.label == "PERSON"

    @property
    def is_name(self) -> bool:
        """Whether the thing has a name of its own."""
        return self.label not in ("", *NUMBERS)


@dataclass(frozen=True, slots=True)
class Turn:
    """A question with its answer, or other words of the agent.

    The question can be understood alone. It is empty if the words of the agent are no answer.
    """

    question: str
    answer: str
    title: str
    """The title of the document with the answer; empty if the answer was computed, or is from no document."""
    at: float
    """The time of the question, in seconds since the context began."""
    asked: tuple[Thing, ...] = ()
    """The things in the question. The thing that a pronoun most likely means comes first."""
    told: tuple[Thing, ...] = ()
    """The things that only the answer names, not the question. The thing that a pronoun most likely means comes first."""
    items: tuple[str, ...] = ()
    """The members of the longest list in the answer."""
    sexes: tuple[tuple[str, str], ...] = ()
    """Names, each with its pronoun: ``he`` or ``she``."""
    source: str = ""
    confidence: float = 1.0

    @property
    def subject(self) -> str:
        """The name that the question is about; empty if there is none."""
        return next((thing.text for thing in self.asked if thing.is_name), "")

    @property
    def defines(self) -> bool:
        """Whether the question only asks for its subject: *who is Clara Venn?*. A pronoun then means the subject."""
        return self.question.lower().startswith(("who is", "who was")) and [t.text for t in self.asked] == [self.title]


@dataclass(frozen=True, slots=True)
class Reading:
    """A complete question that an utterance may stand for."""

    text: str
    prior: float = 0.0
    """The likelihood of the reading before the documents are searched, in log odds."""
    about: str = ""
    """The subject, if it comes from the thread; `text` may name it, too."""
    new: str = ""
    """The words of the utterance that the reading adds to an earlier question or a name. A passage of a document counts
    only if it has these words or their variants."""


def turn_of(asked: Parse, found: Answer, at: float) -> Turn:
    """Return the turn of a complete question and its answer."""
    answer, title, words = found.text, found.title, set(asked.text.lower().split())
    told, named, all_asked = parse(answer), set(_bare(title).split()), things_of(asked)
    things = [thing for thing in all_asked if not named.issuperset(_bare(thing.text).split())]
    label = next((thing.label for thing in all_asked if _bare(thing.text) == _bare(title)), "")
    whole = [Thing(title, label or "TITLE")] if title else []
    in_question = _bare(title) in asked.tree.text.lower()
    things += whole if in_question else []
    things = [thing for thing in things if thing.label not in ("ORDINAL", "CARDINAL")]
    things.sort(key=lambda thing: not thing.is_name)
    new = [thing for thing in things_of(told) if not (words | named).issuperset(_bare(thing.text).split())]
    new = [*(whole if not in_question and title.lower() in answer.lower() else []), *new]
    sexes: list[tuple[str, str]] = []
    if asked.kind is QuestionWord.PERSON and new:
        name = min(new, key=lambda thing: (not thing.is_person, not thing.is_name))
        new = [replace(thing, label="PERSON") if thing is name else thing for thing in new]
        sexes = [(name.text, sex) for sex in ("he", "she") if not words_of(sex).isdisjoint(words)]
    items = max(_lists(told.tree), key=len, default=())
    question, source = asked.text.rstrip("?"), found.source
    return Turn(question, answer, title, at, tuple(things), tuple(new), items, tuple(sexes), source, found.confidence)


def overheard(said: str, at: float) -> Turn:
    """Return a turn for words of the agent that are no answer. Later questions may refer to the names in them."""
    return Turn("", said, "", at, told=tuple(thing for thing in things_of(parse(said)) if thing.is_name))


def things_of(seen: Parse) -> list[Thing]:
    """Return the noun phrases of a text. *The mayor of Tarm* gives *the mayor*, *Tarm*, and the whole phrase."""
    found: dict[str, Thing] = {}
    for word in seen.tree.words:
        own = phrase_of(seen.tree, word) if is_noun(word) else []
        if not own or any(other.tag in WH for other in own):
            continue
        if word.dep == "attr" and any(child.low in ("a", "an") for child in seen.tree.children(word, "det")):
            continue  # the noun only names a kind of thing: "Lima is a city"
        entity = next((e for e in seen.entities if e.start < word.end and word.start < e.end), None)
        label = entity.label if entity else ""
        text = entity.text.removesuffix("'s") if entity and label == "PERSON" else seen.tree.phrase(own)
        found.setdefault(text.lower(), Thing(text, label or ("NAME" if word.pos == "PROPN" else "")))
        for of in seen.tree.children(word, "prep"):
            if of.low == "of":
                text = seen.tree.phrase([*own, *seen.tree.subtree(of)])
                found.setdefault(text.lower(), Thing(text, ""))
    return list(found.values())


def is_noun(word: Word) -> bool:
    """Return whether a word is the head of a noun phrase."""
    return word.pos in ("NOUN", "PROPN", "X") and word.dep not in ("compound", "nmod", "amod")


def phrase_of(tree: Tree, head: Word) -> list[Word]:
    """Return a noun with the words before it that belong to it."""
    left = [child for child in tree.children(head, *_OWN) if child.index < head.index]
    return [*(word for child in left for word in tree.subtree(child)), head]


def _bare(text: str) -> str:
    return text.lower().removeprefix("the ")


def _lists(tree: Tree) -> Iterator[tuple[str, ...]]:
    """Yield the members of each enumeration."""
    for word in tree.words:
        members = [word]
        while nexts := tree.children(members[-1], "conj"):
            members.append(nexts[0])
        if len(members) > 2 and tree.children(word, "nummod"):  # "two moons, Ibo and Usk"
            members = members[1:]
        if len(members) > 1 and is_noun(word) and word.dep != "conj":
            yield tuple(tree.phrase(phrase_of(tree, member)) for member in members)


# ------------------------------------------------------------------------------------------------ readings


def readings(seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str] = lambda _: "") -> list[Reading]:
    """Return the questions that an utterance may stand for, roughly in order of likelihood.

    The list is empty if the utterance refers to something outside the thread, or asks nothing, as *really?* does.

    Args:
        seen: The utterance.
        thread: The latest questions, oldest first.
        titled: A function from a name, in upper or lower case, to the title of a document about it, or "".
    """
    if not seen.asked or len(seen.text) > LONGEST:
        return [Reading(seen.text)]
    if not thread:
        return [] if _leans(seen) else [Reading(seen.text)]
    found: dict[str, Reading] = {}
    follow = _Follow(seen, thread, titled)
    for reading in [*follow.readings()] or follow.about():
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
    subjects = ("nsubj", "nsubjpass")  # "how do plants make their food?"
    return not any(w.pos in ("NOUN", "PROPN") and w.index < word.index and w.dep in subjects for w in words)


def referents(pronoun: Word, thread: Sequence[Turn]) -> list[Thing]:
    """Return up to six things in the last two turns that a pronoun may stand for, most likely first."""
    sex, there = SEXES.get(pronoun.low), pronoun.low == "there"
    known = {name: said for turn in thread for name, said in turn.sexes}
    found: dict[str, Thing] = {}
    for turn in reversed(thread[-2:]):
        told_first = not turn.defines and (sex or there or turn.question.lower().startswith(("what ", "which ")))
        things = [*turn.told, *turn.asked] if told_first else [*turn.asked, *turn.told]
        for thing in sorted(things, key=lambda thing: not thing.label):
            if not sex or known.get(thing.text, sex) == sex:
                found.setdefault(thing.text.lower(), thing)
    things = [thing for thing in found.values() if thing.label not in NUMBERS]
    if sex:
        likely = [thing for thing in things if thing.label in ("PERSON", "TITLE", "NAME")]
        likely.sort(key=lambda thing: not thing.is_person)
    else:
        likely = [thing for thing in things if not thing.is_person and (thing.is_name or not there)]
    if thread and thread[-1].defines:
        likely = list(dict.fromkeys((*thread[-1].asked, *likely)))
    return (likely if likely and (sex or there) else [*likely, *(t for t in things if t not in likely)])[:6]


def correction(seen: Parse) -> list[Word]:
    """Return the words for the thing that the user meant: *Mount Olin* in *I meant Mount Olin*. Otherwise, return []."""
    root = next((word for word in seen.asked if word.lemma == "mean" and word.head == word.index), None)
    if root is None or not any(word.low == "i" for word in seen.tree.children(root, "nsubj")):
        return []
    things = [word for word in seen.tree.children(root, "dobj", "attr", "oprd") if is_noun(word)]
    return seen.tree.subtree(things[0]) if things else []


class _Follow:
    """An utterance that follows the questions of a thread."""

    def __init__(self, seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str]) -> None:
        self.seen, self.tree, self.thread = seen, seen.tree, thread
        self.last = thread[-1]
        self.before = [turn for turn in reversed(thread) if turn.question]
        words = said = [word for word in seen.asked if word.pos != "PUNCT"]
        while words and (words[0].pos == "CCONJ" or words[0].low in ("so", "then", "ok")):
            words = words[1:]
        if [word.low for word in words[:2]] in (["what", "about"], ["how", "about"]):
            words = words[2:]
        self.words, self.leads = words, len(words) < len(said)
        self.text = self.tree.phrase(words)
        self.pronouns = [word for word in words if refers(word, words)]
        heads = [self.tree.phrase(phrase_of(self.tree, word)) for word in words if is_noun(word)]
        self.named = any(is_name(seen, word) for word in words) or any(map(titled, (self.text, *heads)))
        self.names = [thing for thing in (*self.last.asked, *self.last.told) if thing.is_name]

    def readings(self) -> Iterator[Reading]:
        """Yield the readings, roughly in order of likelihood."""
        words = self.words
        one = next((w for w in words if w.low in _ONES and w.pos in ("NUM", "NOUN", "PRON", "ADJ")), None)
        rest = [word for word in words if word not in self.pronouns]
        if meant := correction(self.seen):
            yield from self._instead(meant)
        elif one is not None:
            yield from self._chosen(one)
        elif rest and rest[0].tag in WH and all(word.tag in WH or word.lemma == "be" for word in rest):
            yield from self._instead(rest[:1])  # "and when was that?"
            yield from self._resolved() if self.pronouns else ()
        elif words and not any(word.tag in FINITE for word in words):
            if not any(word.pos in ("NOUN", "PROPN", "NUM", "ADJ", "X") or word.tag in WH for word in words):
                return  # "really?"
            if self.pronouns:
                yield from self._resolved()
            else:
                yield from ([] if self.leads or not self.named else [self._alone(0.0)])
                yield from self._instead(words)
                yield from self.about()
                of = self.named and any(word.low == "of" for word in words[1:])
                yield from ([] if self.leads and not of else [self._alone(-1.0)])
        elif self.pronouns:
            yield from self._resolved()
            if sum(word.pos in ("NOUN", "PROPN", "VERB") for word in words) > 1:
                yield self._alone(-1.0)  # "when did it start to rain?"
        elif words:
            yield from ([] if self.named else self.about())
            yield self._alone(0.0 if self.named or self.leads else -1.0)

    def _alone(self, prior: float) -> Reading:
        return Reading(f"{self.text}?" if self.seen.kind is not None else self.text, prior)

    def about(self) -> Iterator[Reading]:
        """Yield the utterance as a question about each name in the last turn: *who was on board?*."""
        for rank, thing in enumerate(self.names if self.words else ()):
            noun = not any(word.tag in (*FINITE, *WH) for word in self.words)
            of = f" of {thing.text}" if noun else ""
            yield Reading(f"{self.text}{of}?", LESS * rank, thing.text, self.text if noun else "")

    def _resolved(self) -> Iterator[Reading]:
        """Yield the utterance once for each thing that its pronoun may stand for, with the thing in its place."""
        less = 12 * LESS if self.pronouns[0].low == "there" else LESS
        for rank, thing in enumerate(referents(self.pronouns[0], self.thread)):
            yield Reading(self._with(self.words, thing.text), less * rank, thing.text)

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
        return _question(parts)

    def _chosen(self, one: Word) -> Iterator[Reading]:
        """Yield the questions that *the first one* or *the other one* may stand for.

        It may mean a member of a list, the subject of an earlier question, a rank, or a kind of thing. For example,
        *the biggest one* may mean the biggest volcano.
        """
        own = [word for word in phrase_of(self.tree, one) if word in self.words]
        before = self.tree.before(own[0])
        own = [before, *own] if before is not None and before.low == "the" else own
        rest = [word for word in self.words if word not in own]
        if any(word.tag in WH for word in rest) and rest[0].index > one.index:  # "the first one, who climbed it?"
            words = rest
        else:
            words = self.words if any(word.tag in FINITE for word in rest) else []
        low = {word.low for word in own}
        subjects = [*dict.fromkeys(turn.asked[0].text for turn in self.thread if turn.asked)]
        for group in (*(turn.items for turn in reversed(self.thread[-2:]) if turn.items), subjects):
            places = [place for rank, place in _RANKS.items() if rank in low and -len(group) <= place < len(group) > 1]
            for thing in (*(group[-2::-1] if "other" in low else ()), *(group[place] for place in places)):
                yield from [Reading(self._with(words, thing, own))] if words else self._instead(own, thing)
        if not words:
            yield from self._instead([word for word in own if word is not one])
        kinds = [thing for thing in self.last.asked if not thing.label] if one.low in ("one", "ones") else []
        for rank, kind in enumerate(kinds if own != self.words else ()):  # "which is the biggest one?" about volcanoes
            noun = kind.text.split()[-1]
            yield Reading(_question([noun if word is one else word.text for word in self.words]), LESS * (rank + 1))

    def _instead(self, new: Sequence[Word], text: str = "") -> Iterator[Reading]:
        """Yield earlier questions, latest first, with new words in place of a part of the same kind.

        A part is the question word (*and when?*), the rank (*and the second highest?*), a name or a noun. A new question
        word gives one question at most. If the new words begin with a preposition (*and of Spain?*), names and nouns
        after the same preposition are replaced; if there are none, any are. Such words also give one more question: the
        last question with these words at its end.
        """
        if not new:
            return
        text = text or self.tree.phrase(new)
        first, last = new[0], new[-1]
        for back, turn in enumerate(self.before):
            words = [word for word in parse(turn.question).tree.words if word.pos != "PUNCT"]
            asks = next((place for place, word in enumerate(words) if word.tag in WH), None)
            if any(word.tag in WH for word in new):
                if asks is not None:
                    verbs = (p for p, word in enumerate(words) if p > asks and word.pos in ("AUX", "VERB"))
                    rest = [word.text for word in words[next(verbs, asks + 1) :]]
                    yield Reading(_question([text, *rest]), LESS * back)
                    return
                continue
            ranks = [p for p, word in enumerate(words) if word.tag in ("JJS", "RBS") or word.low in words_of("ranks")]
            if last.tag in ("JJS", "RBS") or (last.low in words_of("ranks") and not self.named):
                if ranks:
                    left = [word.text for word in words[: ranks[0]]]
                    left = left[:-1] if left[-1:] == ["the"] and first.low == "the" else left
                    rest = [word.text for word in words[ranks[-1] + 1 :]]
                    yield Reading(_question([*left, text, *rest]), LESS * back)
                continue
            leading = first.pos in ("ADP", "SCONJ")
            fresh = self.tree.phrase(new[1:]) if leading and not text.startswith("the ") else text
            olds = [thing.text for thing in turn.asked if thing.is_name or not (self.named or turn is not self.last)]
            olds = [old for old in olds if not leading or f"{first.low} {old}".lower() in turn.question.lower()] or olds
            for rank, old in enumerate(olds):
                at = turn.question.lower().find(old.lower())
                if at >= 0:
                    swapped = f"{turn.question[:at]}{fresh}{turn.question[at + len(old) :]}?"
                    yield Reading(swapped, LESS * (rank + back), new=fresh)
            if leading and turn is self.last:
                yield Reading(f"{turn.question} {text}?", LESS, new=text)


def _question(parts: Sequence[str]) -> str:
    """Return words as a question."""
    return " ".join(parts).replace(" 's", "'s").replace(" n't", "n't").strip(" ?!.,") + "?"
