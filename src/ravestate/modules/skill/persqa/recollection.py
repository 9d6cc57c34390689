"""Find the user's own sentence that answers their question: *what may I not eat?*."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from ravestate.errors import PlatformError
from ravestate.language.contractions import word_set
from ravestate.language.reranker import Reranker
from ravestate.modules import nlp

from .advice import may_ask_for_help

CLEARLY = 2.0
"""The least lead of the best sentence over the second best, in logits (raw scores of the network). Scores alone say too
little, because some questions have higher scores than others."""
LEAST = -7.0
"""The least score of an answer, in logits. A wrong answer is worse than no answer."""
LIKELY = 0.4
"""The least confidence that the user wants to be reminded, for a question without a verb such as *remember* or *tell*."""
LONGEST = 160
"""The maximum length of a sentence to quote, in characters."""
SHORTEST = 3
"""The minimum number of words of a sentence to quote."""

_MINE = word_set("i my me mine we our us")
_REMINDING = word_set("remember recall told said tell say mention mentioned")
_SAID = re.compile(
    r"\b(?:did|was) (?:i|we) (?:just |already |been )?(?:say|said|tell|telling|told|mention)", re.IGNORECASE
)


def asks_to_repeat(seen: nlp.Analysis) -> bool:
    """Return whether the user asks for their own words: *what sum did I say?*."""
    return seen.question is not None and _SAID.search(seen.text) is not None


def asks_for_words(seen: nlp.Analysis) -> bool:
    """Return whether the user asks for something that they may have told in this conversation."""
    question = next((one for one in reversed(seen.sentences) if one.rstrip().endswith("?")), seen.text)
    words = set(re.findall(r"[a-z]+", question.lower()))
    if seen.question is None or (seen.question == nlp.QuestionWord.YES_NO and not words & _REMINDING):
        return False
    told = _REMINDING if "did" in words else _REMINDING - {"tell", "say", "mention"}
    reminding = words & told and words & {"i", "you"}
    if not reminding and seen.move is not None and (seen.move.name != "recall" or seen.move.score < LIKELY):
        return False
    return bool(reminding or words & _MINE) and (bool(words & {"remember", "recall"}) or not may_ask_for_help(question))


def recollect(question: str, sentences: Sequence[str]) -> str:
    """Return the words that answer a question: one sentence, or two adjacent sentences; empty if no answer is clear.

    This takes about 3 ms per sentence.
    """
    known = [one for one in dict.fromkeys(sentences) if len(one) <= LONGEST and len(one.split()) >= SHORTEST]
    if not known:
        return ""
    try:
        scores = _reranker().score(question, known).tolist()
    except PlatformError:  # `recalled` in told.py still finds statements with the same words
        return ""
    best, *others = sorted(range(len(known)), key=lambda place: -scores[place])
    answer, bar = known[best], scores[best] - CLEARLY
    if others and scores[others[0]] > bar and abs(others[0] - best) == 1:
        first, second = sorted((best, others.pop(0)))
        answer = f"{known[first].strip()} {known[second].strip()}"
    clear = scores[best] >= LEAST and all(scores[place] <= bar for place in others)
    return answer.strip() if clear and len(answer) <= LONGEST else ""


@cache
def _reranker() -> Reranker:
    return Reranker()
