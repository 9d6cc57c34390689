"""The sentence of an utterance that asks something, and the kind of a question."""

from __future__ import annotations

import re
from functools import lru_cache

from ravestate.language.contractions import word_set
from ravestate.language.matcher import bundled_matcher
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QuestionWord
from ravestate.modules.meta.nlp.tree import SUBJECTS, Tree, Word

from .turns import is_cry, is_news

ASKING = word_set("who what when where why which how whose do does did is are was can could will would should may have")
"""Function words that begin a question."""
_ASKED = word_set(
    "who what when where why which how whose whether if or you your right correct yes no ok okay huh eh innit"
)
"""Last words of questions that are worded like a statement: *you are not mad, are you?*, *is correct, yes?*"""
FEW_WORDS = 3
"""If an utterance has several sentences, its question must have at least this many words. Shorter sentences resemble many
others."""
SHORT = 4
"""The maximum number of words in a short answer."""
_AMAZED = re.compile(r"\b(?:can|could|would) you (?:imagine|believe)\b(?: (?:that|it|this))?\W*$", re.IGNORECASE)
"""The end of an astonished statement: *he ate it all, can you believe it?*"""


ORDERS = frozenset(("tell_me", "ask_me", "write", "pick", "recommend", "how_to", "say_word"))
"""Kinds of requests (asks.yaml). After another sentence, such a request is the point of the utterance."""
FELT = 0.8
"""The minimum confidence in a feeling that takes precedence over a request of the kinds `ORDERS`."""
ORDERED = 0.8
"""The minimum confidence in a request of the kinds `ORDERS`."""


def asking_sentence(seen: Analysis) -> str:
    """Return the sentence that asks something, or the request at the end; empty if the utterance has neither."""
    return _question_in(seen) or _order_in(seen)


def _order_in(seen: Analysis) -> str:
    """Return the request at the end of an utterance: *I'm on a night shift. Tell me something interesting.*"""
    if len(seen.sentences) < 2 or any(one.score >= FELT for one in seen.feelings.values()):
        return ""  # "I got the job! Recommend a restaurant."
    last = seen.sentences[-1]
    return (
        last
        if any(one.text == last and one.score >= ORDERED for name, one in seen.asks.items() if name in ORDERS)
        else ""
    )


def _question_in(seen: Analysis) -> str:
    if seen.question is None or not seen.sentences or _AMAZED.search(seen.sentences[-1]):
        return ""
    if is_news(seen.sentences[-1]) or is_cry(seen.text):
        return ""
    marked = [one for one in seen.sentences if one.rstrip().endswith("?") and not is_astonished(seen, one)]
    opened = [sentence for sentence in seen.sentences if sentence.split()[:1] and sentence.split()[0].lower() in ASKING]
    if not marked and not opened and (seen.question is QuestionWord.YES_NO or seen.text.rstrip().endswith("!")):
        return ""  # "I was curious whether you sleep", "oh, we won!"
    if len(seen.sentences) > 1:  # "What?? The whole roof is gone"
        marked = [sentence for sentence in marked if len(sentence.split()) > FEW_WORDS - 1]
        if not marked and not opened and seen.question is QuestionWord.YES_NO:
            return ""
        opened = [sentence for sentence in opened if len(sentence.split()) > FEW_WORDS - 1]
        if not marked and not opened:
            return ""
    last = [*seen.sentences, *opened, *marked][-1]
    place = seen.sentences.index(last)
    if place and len(last.split()) <= SHORT + 1 and kind_of(last) == "you_think":
        return seen.sentences[place - 1]  # "I don't know whether I should go. What do you think?"
    return last


@lru_cache(256)
def kind_of(sentence: str) -> str:
    """Return the kind of a question or request; empty for a statement."""
    match = bundled_matcher("asks").match(sentence)
    return "" if match is None else match.name


def is_astonished(seen: Analysis, sentence: str) -> bool:
    """Return whether a sentence is a statement about others with a question mark: *he says it relaxes them??*"""
    words = [word for word in words_of(seen.tree, sentence) if word.pos not in ("PUNCT", "INTJ", "CCONJ")]
    low = [word.low for word in words]
    if low[-2:] == ["you", "know"] and len(low) > 4:  # "it's been a bad week, you know?"
        return True
    if len(low) < 4 or low[0] in ASKING or not _ASKED.isdisjoint(low):
        return False
    subject = next((word for word in words if word.dep in SUBJECTS), None)
    verb = None if subject is None else seen.tree.head(subject)
    helpers = [] if verb is None else [verb, *seen.tree.children(verb, "aux", "auxpass")]
    return subject is not None and all(word.index > subject.index for word in helpers)


def words_of(tree: Tree, sentence: str) -> list[Word]:
    """Return the words of a sentence; if the text does not contain this sentence, all words of the text."""
    start = tree.text.lower().find(sentence.lower().rstrip(".!?")) if sentence else 0
    end = start + len(sentence) if sentence and start >= 0 else len(tree.text)
    return [word for word in tree.words if max(start, 0) <= word.start < end]
