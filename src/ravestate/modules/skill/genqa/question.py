"""The question in an utterance: its words, its qualifiers, and whether documents can answer it.

Qualifiers are conditions for a passage: words that the passage must have, and words that it must not have.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from ravestate.language.entity import Entity
from ravestate.language.moves import LISTENING
from ravestate.language.network import network
from ravestate.modules._text import printable
from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.meta.nlp.questions import FINITE, WH, asking, is_finite, sentences_in
from ravestate.modules.meta.nlp.tree import Tree, Word

from .lexicon import variants_of, words_of
from .reckoning import scaled

LONGEST = 600
"""The maximum length of an utterance in characters; a longer utterance does not count as a question."""
REMEMBERED = 64
"""The number of parses that are kept."""
THE_TWO = frozenset(["i", "me", "my", "mine", "myself", "you", "your", "yours", "yourself", "u", "ur"])
"""The pronouns for the user and the agent."""
SEXES = {"he": "he", "him": "he", "his": "he", "she": "she", "her": "she", "hers": "she"}
PRONOUNS = frozenset([*SEXES, "it", "its", "they", "them", "their", "there", "this", "that"])
_NAMES = ("GPE", "LOC", "PERSON", "ORG", "FAC", "NORP", "WORK_OF_ART", "EVENT", "PRODUCT", "LANGUAGE")


_OF_ANYBODY = re.compile(rf"\byour (?=(?:{'|'.join(sorted(words_of('body')))})\b)", re.IGNORECASE)
"""The *your* of *how many bones are in your leg*, which means everybody's leg."""
_ABOUT_DEEDS = (QuestionWord.REASON, QuestionWord.FORM)
"""Kinds of questions that ask nothing if their only words are a name: *how is Rome?*."""


@dataclass(frozen=True, slots=True)
class Question:
    """A question about the world."""

    text: str
    """The text of the question, without the rest of the utterance."""
    words: tuple[str, ...] = ()
    """The words for the question's subject, in order, each once."""
    kinds: tuple[str, ...] = ()
    """The words for the kind of answer, such as *population*."""
    given: frozenset[str] = frozenset()
    """The words of the names in the question; every passage about the named things has these words."""
    needs: tuple[tuple[str, ...], ...] = ()
    """The qualifiers of the question: a passage must have a word of each tuple."""
    avoids: tuple[str, ...] = ()
    """Words that a passage must not have, such as ranks that the question does not name."""
    kind: QuestionWord | None = None
    doubtful: bool = False
    """Whether only a sure answer counts, because the utterance might not be a question about the world."""
    follows: bool = False
    """Whether the question was completed from earlier questions. If so, names do not count for the confidence."""
    counted: str = ""
    """The noun after *how many*, which a passage must have in its own text; empty if there is none."""
    declined: str = ""
    """The reason why documents cannot answer the question; empty if they can."""


@dataclass(frozen=True, slots=True)
class Parse:
    """The parse of an utterance, and the words of the question in it."""

    tree: Tree
    entities: tuple[Entity, ...]
    kind: QuestionWord | None
    asked: tuple[Word, ...]
    """The words of the question alone, without *can you tell me*."""

    @property
    def text(self) -> str:
        """The text of the question, without the rest of the utterance."""
        text = _OF_ANYBODY.sub("the human ", self.tree.phrase(self.asked).replace(" ,", ",").strip(" ?!.,;:"))
        return f"{text}?" if text and self.kind is not None else text

    @property
    def is_finite(self) -> bool:
        """Whether the question has a finite verb."""
        return is_finite(self.asked)


def parse(text: str) -> Parse:
    """Parse a text with the pipeline of nlp. Recent parses are kept, because the same text often comes again."""
    return _parse(text, network().loaded)


@lru_cache(maxsize=REMEMBERED)
def _parse(text: str, _loaded: bool) -> Parse:
    tree, entities = pipeline("").read(printable(text))
    return parsed(tree, entities, question_of(tree.text))


def parsed(tree: Tree, entities: Sequence[Entity], kind: QuestionWord | None) -> Parse:
    """Return the parse. Its question is the first sentence that asks something, or else the last sentence."""
    asked = (asking(tree) or sentences_in(tree)[-1:] or [[]])[0]
    root = next((word for word in asked if word.head == word.index), None)
    if root is not None:
        asked = _alone(tree, root, asked)
    while asked and (asked[0].pos in ("PUNCT", "INTJ", "SPACE") or asked[0].low in ("so", "well", "but")):
        asked = asked[1:]
    return Parse(tree, tuple(entities), kind, tuple(asked))


def _alone(tree: Tree, root: Word, asked: list[Word]) -> list[Word]:
    """Return the words of the question inside a request: *can you tell me ...*, *do you know ...*, *name ...*."""
    for child in tree.children(root, "ccomp", "advcl"):  # "what is the capital of Peru, my son asked"
        quoted = tree.subtree(child)
        if quoted[-1].index < root.index and quoted[0].tag in WH:
            return quoted
    subject = next(iter(tree.children(root, "nsubj")), None)
    if subject is not None and subject.low not in THE_TWO:
        return asked
    for child in tree.children(root, "ccomp", "advcl", "xcomp", "relcl", "csubj"):
        inner = tree.subtree(child)
        mark = inner[0]
        if mark.low in ("if", "whether"):
            return inner[1:]
        if mark.tag in WH or (inner[1:] and mark.pos == "ADP" and inner[1].tag in WH):
            return inner
    if root.lemma not in words_of("asking"):
        return asked
    near = (root, *tree.children(root, "dobj", "dative"))
    about = next((word for word in asked if word.low == "about" and tree.head(word) in near), None)
    things = tree.children(about, "pobj") if about else tree.children(root, "dobj", "oprd", "attr", "ccomp")
    thing = next((word for word in things if word.low not in THE_TWO and word.tag not in WH), None)
    return asked if thing is None else tree.subtree(thing)


def as_question(heard: str | Parse) -> Question:
    """Return the question in an utterance.

    Example:
        >>> as_question("Hello! Can you tell me what the capital of Peru is?").words
        ('capital', 'Peru')
        >>> as_question("What is your name?").declined
        'it is about the user or the agent'
    """
    if isinstance(heard, str):
        if len(heard) > LONGEST:
            return Question(heard[:LONGEST], declined="it is too long for a question")
        heard = parse(heard)
    said = [word for word in heard.asked if word.pos != "PUNCT"]
    content = list(dict.fromkeys(part for word in said if _means(word) for part in _parts(word)))
    kinds = tuple(part for word in said for part in _parts(word) if part.lower() in words_of("kinds"))
    words = tuple(word for word in content if word not in kinds) or tuple(content)  # kinds alone: "What is time?"
    reason, doubtful = _declined(heard, said), heard.kind is None
    if not reason and content and all(word.lower() in words_of("moment") for word in content):
        reason = "it is about the moment, which documents do not know"
    named = {part for word in said if is_name(heard, word) for part in _parts(word)}
    if not reason and words and heard.kind in _ABOUT_DEEDS and named.issuperset(words):
        reason = "it has only a name, and asks nothing about it"
    if not reason and not words:
        reason = "it has no word to look for"
    if any(word.low in THE_TWO for word in said):
        doubtful = True
    needs, avoids = _qualifiers(heard)
    given = frozenset(map(str.lower, named))
    return Question(
        heard.text,
        words,
        kinds,
        given,
        tuple(needs),
        tuple(sorted(avoids)),
        heard.kind,
        doubtful,
        counted=_counted(heard),
        declined=reason,
    )


def _counted(heard: Parse) -> str:
    """Return the noun after *how many*; empty if there is none, or if it is one of the `kinds`."""
    nouns = [heard.tree.head(word) for word in heard.asked if word.low == "many"][:1]
    return next((noun.text for noun in nouns if noun.pos == "NOUN" and noun.low not in words_of("kinds")), "")


def is_name(seen: Parse, word: Word) -> bool:
    """Return whether a word is a part of a name."""
    return word.pos == "PROPN" or any(e.label in _NAMES and e.start <= word.start < e.end for e in seen.entities)


def _parts(word: Word) -> list[str]:
    return re.findall(r"[^\W_]+", word.text)


def _means(word: Word) -> bool:
    if word.low in words_of("light") or word.tag in WH or word.low in THE_TWO:
        return False
    return word.pos not in ("AUX", "DET", "PRON", "ADP", "CCONJ", "SCONJ", "PART", "INTJ", "PUNCT", "SYM") or (
        word.low in words_of("excluding")
    )


def _declined(heard: Parse, said: Sequence[Word]) -> str:
    """Return the reason why documents cannot answer the question; empty if they can."""
    root = next((word for word in said if word.dep == "ROOT" or word.head == word.index), None)
    modal = next((word for word in said if word.tag == "MD" and word.dep in ("aux", "ROOT")), None)
    if any(word.low in THE_TWO and not _is_anybody(heard, word) for word in said):
        return "it is about the user or the agent"
    if modal is not None and modal.lemma in ("will", "shall"):
        return "it is about the future, which documents do not know"
    if modal is not None and modal.low == "should" and heard.kind is QuestionWord.YES_NO:
        return "it asks for an opinion"
    if root is not None and root.tag == "VBG" and any(word.low == "it" for word in said):
        return "it is about the moment, which documents do not know"
    return ""


def _is_anybody(heard: Parse, word: Word) -> bool:
    """Return whether *you* or *I* stands for people in general: *how do you make ice cream*, *where must I pay*."""
    verb = heard.tree.head(word)
    if word.low == "your" and verb.low in words_of("body"):
        return heard.kind in (QuestionWord.AMOUNT, QuestionWord.REASON, QuestionWord.OBJECT)
    if word.dep not in ("nsubj", "nsubjpass") or verb.pos not in ("VERB", "AUX") or word.low not in ("you", "i"):
        return False
    if verb.dep == "ccomp" and heard.tree.head(verb).lemma == "make":  # "why do onions make you cry"
        return heard.kind is QuestionWord.REASON and not {"i", "me", "my"} & {other.low for other in heard.tree.words}
    helpers = heard.tree.children(verb, "aux")
    things = [other for other in heard.tree.subtree(verb) if other.pos in ("NOUN", "PROPN")]
    if any(helper.tag == "VBD" for helper in helpers) or verb.tag == "VBD":
        return False
    if verb.dep == "advcl":
        return True
    if heard.kind is QuestionWord.YES_NO and word.low == "you" and any(helper.low == "can" for helper in helpers):
        return verb.lemma in words_of("anybody") and bool(things)
    if heard.kind not in (QuestionWord.FORM, QuestionWord.PLACE, QuestionWord.TIME, QuestionWord.AMOUNT):
        return any(helper.low in ("must", "may") for helper in helpers)
    return bool(things) or any(helper.tag == "MD" for helper in helpers)


def _qualifiers(heard: Parse) -> tuple[list[tuple[str, ...]], list[str]]:
    """Return the words that a passage must have, and the words that it must not have."""
    needs: list[tuple[str, ...]] = []
    avoids: list[str] = []
    tree, ranks = heard.tree, words_of("ranks")
    named = {i for e in heard.entities if e.label in (*_NAMES, "DATE", "TIME") for i in range(e.start, e.end)}
    decides = heard.kind is QuestionWord.YES_NO  # a passage with another name may mean "no": "The capital is Berlin."
    asked_ranks = {word.low for word in heard.asked if word.low in ranks}
    for word in heard.asked:
        if word.dep == "neg" or word.low in ("no", "never"):
            before = tree.before(word)
            if not decides and not (before is not None and before.pos == "CCONJ"):  # "why 42 and not 41?"
                needs.append(("not", "no", "never", "none", "without"))
        elif word.low in ("before", "after") and any(o.tag not in ("CD", "WDT") for o in tree.children(word, "pobj")):
            needs.append(tuple(sorted(words_of("order"))))
        elif word.low in words_of("excluding"):
            needs.append(tuple(sorted(words_of("excluding"))))
        elif _is_superlative(tree, word) or word.low in ranks:
            needs.append(variants_of(word.text))
            picked = [other.text for other in _picked(tree, word) if other in heard.asked]
            needs += [variants_of(other) for other in picked]
            if not asked_ranks:
                avoids += ranks - {"first", "next", "only", "last"}
            if words_of("women").isdisjoint(map(str.lower, picked)):
                avoids += words_of("women")
            if not any(other.low in words_of("excluding") for other in heard.asked):
                avoids += words_of("excluding")
        elif decides and needs:
            continue
        elif any(c.isdigit() for c in word.text) or (_means(word) and (word.pos == "PROPN" or word.start in named)):
            needs += [variants_of(part) for part in _parts(word) if part.lower() not in words_of("kinds")]
    return list(dict.fromkeys(needs)), avoids


def _is_superlative(tree: Tree, word: Word) -> bool:
    """Return whether a word is a superlative. The *most* in *most people* is not a superlative."""
    if word.low in ("most", "least") and tree.head(word).pos == "NOUN":
        before = tree.before(word)
        return before is not None and before.low == "the" and word.tag in ("JJS", "RBS")
    return word.tag in ("JJS", "RBS")


def _picked(tree: Tree, rank: Word) -> Iterator[Word]:
    """Yield the content words of the phrase in which a rank picks one of many: *second longest river in Africa*."""
    head = tree.head(rank)
    if head.pos not in ("NOUN", "PROPN"):
        return
    for word in tree.subtree(head):
        if _means(word) and word != rank and word.low not in words_of("kinds") | words_of("people") | words_of("ranks"):
            yield word


def is_vague(question: Question) -> bool:
    """Return whether a question says little more than *it* or *they*.

    Example:
        >>> is_vague(as_question("Can they fly?")), is_vague(as_question("When did it start to rain?"))
        (True, False)
    """
    others = PRONOUNS - {"there"}
    return len(question.words) < 2 and not others.isdisjoint(question.text.strip("?").lower().split())


def not_asked(heard: Parse, analysis: Analysis) -> str:
    """Return the reason why an utterance asks for nothing; empty if it may be a question."""
    if any(word.lemma == "mean" and word.head == word.index for word in heard.asked):  # "no, I meant ..."
        return ""
    if len(analysis.text) > LONGEST:
        return "it is too long for a question"
    words = [word for word in heard.asked if word.pos != "PUNCT"]
    if len(words) == 1 and not words[0].index and words[0].tag not in WH and len(analysis.sentences) > 1:
        return "it only repeats a word"  # "Holiday? In this weather?"
    if scaled(analysis.text):
        return ""
    told = (
        analysis.question is None
        and "?" not in analysis.text
        and any(word.tag in FINITE for word in analysis.tree.words)
    )
    if analysis.move is not None and (analysis.move.listens or (told and analysis.move.name in LISTENING)):
        return f"the user wants another answer: {analysis.move.name}"
    if analysis.advised:
        return "the user wants advice or an opinion"
    if heard.kind is not None:
        return ""
    if any(match.score >= 0.5 for match in analysis.acts.values()):
        return "it is small talk"
    if heard.is_finite and not any(word.tag in WH for word in heard.asked):
        return "it is not a question"
    return ""
