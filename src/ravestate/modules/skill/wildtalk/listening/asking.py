"""The sentence of an utterance that asks something, and the kind of a question."""

from __future__ import annotations

import re
from functools import lru_cache

from ravestate.language.matcher import bundled_matcher
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QuestionWord

from .echo import ASKING, is_astonished
from .turns import is_cry, is_news

FEW_WORDS = 3
"""The maximum number of words of a short sentence. Short sentences resemble many others."""
SHORT = 4
"""The maximum number of words in a short answer."""
_AMAZED = re.compile(r"\b(?:can|could|would) you (?:imagine|believe)\b(?: (?:that|it|this))?\W*$", re.IGNORECASE)
"""The end of an astonished statement: *he ate it all, can you believe it?*"""


ORDERS = frozenset(("tell_me", "ask_me", "write", "pick", "recommend", "how_to", "say_word"))
"""Kinds of requests (asks.yaml). After another sentence, such a request is the point of the utterance."""
FELT = 0.8
"""The minimum confidence in a feeling that takes precedence over such a request."""
ORDERED = 0.8
"""The minimum confidence in such a request."""


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
