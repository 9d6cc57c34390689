"""The thread of a talk: the latest questions with their answers, and later questions completed from them.

A follow-up has several readings: *when was he born?* may mean anybody in view. `readings` yields them in order of
likelihood, and the documents decide between them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.tree import Tree, Word

from .answering import Answer
from .lexicon import words_of
from .question import PRONOUNS, Parse, is_name, parse

NUMBERS = ("DATE", "TIME", "CARDINAL", "QUANTITY", "MONEY", "PERCENT", "ORDINAL")
"""The labels of entities that are no names."""
LONGEST = 200
"""Characters of a question that may refer to another."""
KEPT = 6
"""The number of questions that stay in view."""
REMEMBERED = 120.0
"""Seconds for which later questions may refer to one."""


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that a question or an answer names."""

    text: str
    label: str
    """The label of the entity; empty for a common noun."""

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
    """The title of the document with the answer."""
    at: float
    """Its time, in seconds since the context began."""
    asked: tuple[Thing, ...] = ()
    """What the question is about, most likely first."""
    told: tuple[Thing, ...] = ()
    """What only the answer names, most likely first."""
    items: tuple[str, ...] = ()
    """The members of a list in the answer."""
    sexes: tuple[tuple[str, str], ...] = ()
    """Names with the pronoun that the user chose for them."""
    source: str = ""
    confidence: float = 1.0

    @property
    def subject(self) -> str:
        """What the question is about; empty for sums."""
        return next((thing.text for thing in self.asked if thing.is_name), "")


def turn_of(asked: Parse, found: Answer, at: float, sexes: tuple[tuple[str, str], ...] = ()) -> Turn:
    """Return the turn of a complete question and its answer."""
    answer, title = found.text, found.title
    told = parse(answer)
    things = [
        Thing(title, thing.label or "TITLE") if _same(thing.text, title) else thing
        for thing in things_of(asked)
        if thing.label not in ("ORDINAL", "CARDINAL")
    ]
    if (
        title
        and title.lower() in f"{asked.tree.text} {answer}".lower()
        and not any(_same(t.text, title) for t in things)
    ):
        things.append(Thing(title, next((t.label for t in things if t.text.lower() in title.lower()), "TITLE")))
    words = set(asked.text.lower().split())
    new = [t for t in things_of(told) if not _same(t.text, title) and not words.issuperset(t.text.lower().split())]
    if asked.kind is QuestionWord.PERSON and not any(thing.is_person for thing in new):
        name = next((thing for thing in new if thing.is_name), None)
        new = [Thing(t.text, "PERSON") if t is name else t for t in new]
    for sex in ("he", "she"):
        if not words_of(sex).isdisjoint(words) and asked.kind is QuestionWord.PERSON:
            sexes = (*sexes, *((thing.text, sex) for thing in new if thing.is_person))
    items = max((group for group in _lists(told.tree)), key=len, default=())
    return Turn(
        asked.text.rstrip("?"),
        answer,
        title,
        at,
        tuple(_by_likelihood(things)),
        tuple(new),
        items,
        sexes,
        found.source,
        found.confidence,
    )


def _by_likelihood(things: Sequence[Thing]) -> list[Thing]:
    return sorted(dict.fromkeys(things), key=lambda thing: not thing.is_name)  # names first


def _same(one: str, other: str) -> bool:
    return one.lower().removeprefix("the ") == other.lower().removeprefix("the ")


def overheard(said: str, at: float) -> Turn:
    """Return a turn of what the agent said without a question to the documents, for its names."""
    told = [thing for thing in things_of(parse(said)) if thing.is_name]
    return Turn("", said, "", at, told=tuple(told))


def refers_back(seen: Parse) -> bool:
    """Return whether an utterance has a pronoun for something that was named before."""
    return any(refers(word, seen.asked) for word in seen.asked)


def things_of(seen: Parse) -> list[Thing]:
    """Return the noun phrases of a text, the longer ones with *of* after their parts."""
    found: dict[str, Thing] = {}
    for word in seen.tree.words:
        if word.pos not in ("NOUN", "PROPN", "X") or word.dep in ("compound", "nmod", "amod") or word.tag == "WP":
            continue
        words = phrase_of(seen.tree, word)
        label = next((e.label for e in seen.entities if e.start < word.end and word.start < e.end), "")
        if any(other.tag == "WRB" for other in words):  # how many people
            continue
        text = seen.tree.phrase(words)
        found.setdefault(text.lower(), Thing(text, label or ("NAME" if word.pos == "PROPN" else "")))
        for preposition in seen.tree.children(word, "prep"):
            whole = [*words, *seen.tree.subtree(preposition)]
            if preposition.low == "of" and not any(w.tag == "WP" for w in whole):
                text = seen.tree.phrase(whole)
                found.setdefault(text.lower(), Thing(text, ""))
    return list(found.values())


def phrase_of(tree: Tree, head: Word) -> list[Word]:
    """Return a noun with its own words to the left."""
    words = [head]
    for child in tree.children(head):
        if child.index < head.index and child.dep in ("det", "amod", "compound", "nummod", "poss", "nmod", "quantmod"):
            words += tree.subtree(child)
    return sorted(words, key=lambda word: word.index)


def _lists(tree: Tree) -> Iterator[tuple[str, ...]]:
    """Yield the members of each enumeration."""
    for word in tree.words:
        members, last = [word], word
        while nexts := tree.children(last, "conj"):
            last = nexts[0]
            members.append(last)
        if len(members) > 1 and word.pos in ("NOUN", "PROPN") and word.dep != "conj":
            yield tuple(tree.phrase(phrase_of(tree, member)) for member in members)


# ------------------------------------------------------------------------------------------------ readings


@dataclass(frozen=True, slots=True)
class Reading:
    """A complete question that an utterance may stand for."""

    text: str
    prior: float = 0.0
    """How likely it is before the documents are asked, as a logarithm of odds."""
    about: str = ""
    """Its subject, where the text does not name it; only the documents of the thread count then."""
    sexes: tuple[tuple[str, str], ...] = ()


def readings(seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str] = str) -> list[Reading]:
    """Return the questions that an utterance may stand for; none if it refers to something that is not in view.

    Args:
        seen: The utterance.
        thread: The latest questions, oldest first.
        titled: A function from a name in any case to the title of a document about it; empty if there is none.
    """
    asked = seen.asked
    text = seen.text
    if not asked or len(text) > LONGEST:
        return [Reading(text)]
    if not thread:
        return [] if _leans(seen) else [Reading(text)]
    found: dict[str, Reading] = {}
    for reading in _all(seen, thread, titled):
        found.setdefault(f"{reading.about} {reading.text}".lower().strip("? "), reading)
    return list(found.values())


def _leans(seen: Parse) -> bool:
    """Return whether an utterance cannot be understood alone."""
    words = [word for word in seen.asked if word.pos != "PUNCT"]
    if not any(
        word.pos in ("NOUN", "PROPN", "VERB", "NUM", "ADJ", "X") and word.low not in ("one", "ones") for word in words
    ):
        return True
    if any(word.tag == "PRP$" and not _is_bound(seen.tree, word) for word in words):
        return True
    return words[0].pos == "CCONJ" and not seen.is_finite


def _is_bound(tree: Tree, pronoun: Word) -> bool:
    """Return whether a noun before a pronoun takes it: *how do plants make their food*."""
    return any(word.pos in ("NOUN", "PROPN") and word.index < pronoun.index for word in tree.words)


def _all(seen: Parse, thread: Sequence[Turn], titled: Callable[[str], str]) -> Iterator[Reading]:
    tree, last = seen.tree, thread[-1]
    words = [word for word in seen.asked if word.pos != "PUNCT"]
    if (meant := correction(seen)) is not None:  # "no, I meant Mount Olin"
        yield from _swapped(thread, Thing(tree.phrase(meant), "NAME"))
        return
    while words and (
        words[0].pos == "CCONJ" or (words[0].low in ("what", "how") and words[1:] and words[1].low == "about")
    ):
        words = words[1 if words[0].pos == "CCONJ" else 2 :]
    lead = len(words) < len([word for word in seen.asked if word.pos != "PUNCT"])
    if not words:
        return
    text = tree.phrase(words)
    pronouns = [w for w in words if refers(w, words)]
    ones = [w for w in words if w.low in _ONES and w.pos in ("NUM", "NOUN", "PRON", "ADJ")]
    if ones:
        for item in _items(tree, ones[0], thread):
            phrase = [w for w in phrase_of(tree, ones[0]) if w in words]
            rest = [w for w in words if w not in phrase]
            if any(w.tag in ("VBZ", "VBP", "VBD", "MD") for w in rest):
                yield from _replaced(
                    seen, words, {w.index: (item if w is phrase[0] else "") for w in phrase}, pronouns, item
                )
            else:
                yield from _swapped(thread, Thing(item, "NAME"))
        return
    if not any(w.tag in ("VBZ", "VBP", "VBD", "MD") for w in words):
        yield from _fragments(seen, words, pronouns, thread, titled, lead=lead)
        return
    if pronouns:
        person = any(thing.is_person for thing in last.told)
        for rank, thing in enumerate(referents(pronouns[0], thread)):
            far = 5.0 if pronouns[0].low in SEXES and person and not thing.is_person else 0.0
            sexes = ((thing.text, pronouns[0].low),) if pronouns[0].low in SEXES else ()
            yield Reading(
                _with(seen, words, {p.index: _owned(p, thing.text) for p in pronouns}), -0.4 * rank - far, sexes=sexes
            )
        if any(w.low == "it" for w in pronouns) and any(w.pos in ("NOUN", "PROPN", "VERB") for w in words):
            yield Reading(_mark(text, seen), -1.0)
        return
    named = any(is_name(seen, word) or titled(tree.phrase(phrase_of(tree, word))) for word in words)
    if not named and len(words) < 12:
        for rank, thing in enumerate(t for t in (*last.asked, *last.told) if t.is_name):
            yield Reading(_mark(text, seen), 0.8 - 0.4 * rank, about=thing.text)
    yield Reading(_mark(text, seen), 0.0 if named or lead else -1.0)


_ONES = ("one", "ones", "former", "latter")
SEXES = {"he": "he", "him": "he", "his": "he", "she": "she", "her": "she", "hers": "she"}


def refers(word: Word, words: Sequence[Word]) -> bool:
    if word.low not in PRONOUNS or word.low in ("these", "those"):
        return False
    if word.low == "there":
        return word.dep != "expl" and word.tag != "EX"
    if word.low in ("that", "this"):
        return word.dep in ("nsubj", "nsubjpass", "pobj", "dobj", "attr", "ROOT") and word.tag == "DT"
    return not any(
        w.pos in ("NOUN", "PROPN") and w.index < word.index and w.dep in ("nsubj", "nsubjpass") for w in words
    )


def referents(pronoun: Word, thread: Sequence[Turn]) -> list[Thing]:
    """Return what a pronoun may stand for, most likely first."""
    sex = SEXES.get(pronoun.low)
    known = {name: SEXES[said] for turn in thread for name, said in turn.sexes}
    found: dict[str, Thing] = {}
    for turn in reversed(thread[-2:]):
        things = (
            [*turn.told, *turn.asked]
            if sex or pronoun.low == "there" or _asks_for_thing(turn)
            else [*turn.asked, *turn.told]
        )
        things = sorted(things, key=lambda thing: _unlikely(pronoun.low, sex, thing, known))
        for thing in things:
            if _unlikely(pronoun.low, sex, thing, known) < 3:
                found.setdefault(thing.text.lower(), thing)
    return list(found.values())[:6]


def _asks_for_thing(turn: Turn) -> bool:
    return turn.question.lower().startswith(("what ", "which "))


def _unlikely(pronoun: str, sex: str | None, thing: Thing, known: dict[str, str]) -> int:
    """Return how unlikely a thing is for a pronoun, from 0; 3 and more is out of the question."""
    if sex:
        if known.get(thing.text, sex) != sex:
            return 3
        if _sex_of(thing.text) not in (None, sex):
            return 3
        return (
            0
            if thing.is_person
            else 1
            if thing.label in ("NAME", "TITLE", "ORG", "GPE", "PRODUCT", "WORK_OF_ART", "FAC")
            else 2
        )
    if thing.label in NUMBERS:
        return 3
    if pronoun == "there":
        return 0 if thing.label in ("GPE", "LOC", "FAC") else 1 if thing.label and not thing.is_person else 2
    if pronoun in ("it", "its"):
        return 2 if thing.is_person else 0 if thing.label else 1
    return 0 if thing.label else 1


def _sex_of(text: str) -> str | None:
    return None


def _items(tree: Tree, one: Word, thread: Sequence[Turn]) -> Iterator[str]:
    """Yield what *the first one*, *the other one* may stand for."""
    adjectives = [w.low for w in tree.children(one, "amod", "det", "nummod")] + [one.low]
    subjects = list(dict.fromkeys(name.text for turn in thread for name in turn.asked[:1]))
    lists = [list(turn.items) for turn in reversed(thread[-2:]) if turn.items]
    for group in (*lists, subjects):
        if "other" in adjectives:
            yield from reversed(group[:-1])
        if "former" in adjectives and len(group) > 1:
            yield group[-2]
        for place, rank in enumerate(("first", "second", "third", "fourth", "fifth", "sixth")):
            if rank in adjectives and len(group) > place:
                yield group[place]
        if "last" in adjectives or "latter" in adjectives:
            yield group[-1]


def _owned(pronoun: Word, thing: str) -> str:
    if pronoun.tag == "PRP$":
        return f"{thing}'s"
    if pronoun.low == "there":
        return f"in {thing}"
    return thing


def _with(seen: Parse, words: Sequence[Word], instead: dict[int, str]) -> str:
    """Return words as a question, some of them replaced."""
    parts = [instead.get(word.index, word.text) for word in words]
    return _mark(" ".join(part for part in parts if part).replace(" 's", "'s").replace(" n't", "n't"), seen)


def _mark(text: str, seen: Parse) -> str:
    return f"{text.strip(' ?.!,')}?"


def correction(seen: Parse) -> list[Word] | None:
    """Return the words for what was really meant: *I meant Mount Olin*."""
    root = next((word for word in seen.asked if word.lemma == "mean" and word.head == word.index), None)
    if root is None or not any(word.low == "i" for word in seen.tree.children(root, "nsubj")):
        return None
    things = seen.tree.children(root, "dobj", "attr", "oprd")
    return seen.tree.subtree(things[0]) if things and things[0].pos in ("NOUN", "PROPN", "X") else None


def _replaced(
    seen: Parse, words: Sequence[Word], instead: dict[int, str], pronouns: Sequence[Word], item: str
) -> Iterator[Reading]:
    verb = next((i for i, w in enumerate(words) if w.tag in ("WP", "WRB", "WDT")), 0)
    if verb and all(w.index in instead for w in words[:verb] if w.pos != "PUNCT"):  # "the first one, who climbed it?"
        words = words[verb:]
    yield Reading(_with(seen, words, {**{p.index: _owned(p, item) for p in pronouns}, **instead}))


def _fragments(
    seen: Parse,
    words: Sequence[Word],
    pronouns: Sequence[Word],
    thread: Sequence[Turn],
    titled: Callable[[str], str],
    *,
    lead: bool,
) -> Iterator[Reading]:
    """Yield the readings of an utterance without a verb: *and when?*, *and its captain?*, *and Spain?*."""
    tree, last = seen.tree, thread[-1]
    text = tree.phrase(words)
    named = any(is_name(seen, word) or titled(tree.phrase(phrase_of(tree, word))) for word in words)
    if pronouns:
        for rank, thing in enumerate(referents(pronouns[0], thread)):
            yield Reading(_with(seen, words, {p.index: _owned(p, thing.text) for p in pronouns}), -0.4 * rank)
        return
    if any(w.tag in ("WRB", "WP", "WDT") for w in words):  # and when?
        yield from _asked_anew(text, thread)
        return
    if not lead and named:
        yield Reading(text if seen.kind is None else f"{text}?")
    head = words[-1]
    if head.tag in ("JJS", "JJR", "JJ", "RBS", "RB", "CD") and not named:
        yield from _another_rank(text, thread)
        return
    first = words[0]
    if first.pos in ("ADP", "SCONJ") or first.tag == "IN":
        inner = tree.phrase(words[1:])
        yield from _swapped(thread, Thing(inner, "NAME" if named else ""))
        yield Reading(f"{last.question} {text}?", -0.2)
        return
    if named:
        yield from _swapped(thread, Thing(text, "NAME"))
    for rank, thing in enumerate(t for t in (*last.asked, *last.told) if t.is_name):
        yield Reading(f"{text} of {thing.text}?", -0.4 * rank)
    if not named:
        yield from _swapped(thread, Thing(text, ""))
        if not lead:
            yield Reading(text if seen.kind is None else f"{text}?", -1.0)


def _swapped(thread: Sequence[Turn], new: Thing) -> Iterator[Reading]:
    """Yield the last question about something else."""
    last = _last(thread)
    lower = last.question.lower()
    rank = 0
    for old in last.asked:
        at = lower.find(old.text.lower())
        if at >= 0 and old.is_name == new.is_name:
            yield Reading(f"{last.question[:at]}{new.text}{last.question[at + len(old.text) :]}?", -0.4 * rank)
            rank += 1


def _last(thread: Sequence[Turn]) -> Turn:
    return next((turn for turn in reversed(thread) if turn.question), thread[-1])


def _asked_anew(text: str, thread: Sequence[Turn]) -> Iterator[Reading]:
    """Yield the last question with another question word."""
    last = _last(thread)
    seen = parse(last.question)
    words = [w for w in seen.tree.words if w.pos != "PUNCT"]
    wh = next((w for w in words if w.tag in ("WP", "WRB", "WDT", "WP$")), None)
    if wh is None:
        return
    # The phrase of the question word ends before the verb.
    end = next((w.index for w in words if w.index > wh.index and w.pos in ("AUX", "VERB")), wh.index + 1)
    yield Reading(f"{text} {seen.tree.phrase([w for w in words if w.index >= end])}?")


def _another_rank(text: str, thread: Sequence[Turn]) -> Iterator[Reading]:
    """Yield the last question with another rank: *and the second highest?*."""
    seen = parse(_last(thread).question)
    ranks = [w for w in seen.tree.words if w.tag in ("JJS", "RBS") or w.low in words_of("ranks")]
    if not ranks:
        return
    before = seen.tree.before(ranks[0])
    whole = [
        w
        for w in seen.tree.words
        if (w not in ranks and w is not before) or (before and before.low != "the" and w is before)
    ]
    at = ranks[0].index
    left, right = [w for w in whole if w.index < at], [w for w in whole if w.index > at]
    bare = text if text.lower().startswith("the ") else f"the {text}"
    yield Reading(f"{seen.tree.phrase(left)} {bare} {seen.tree.phrase(right)}?".strip())
