"""Recognise feelings in an utterance: joy, grief, a compliment for the agent... ``feelings.yaml`` lists them."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from .addressing import addressed
from .matcher import Match, bundled_matcher
from .normal import plain
from .shape import shape

SORROWS = frozenset({"grief", "illness", "sadness", "loneliness", "worry", "failure", "anger"})
"""The user's sorrows. While a sorrow lasts, the agent says nothing cheerful, and does not speak out of boredom."""
SORROW_LASTS = 12
"""A sorrow lasts for this number of the user's utterances, including the utterance that shows it."""
SURE = 0.8
"""The least confidence at which a question such as "how do you know that?" shows surprise."""
SHORTEST = 3
"""The minimum number of words in a clause that shows a feeling although its whole sentence shows none.

The clause "brilliant" in "brilliant, it is broken" is shorter, so it is not praise.
"""

_CLAUSE_END = re.compile(
    r"[,;:()–—…]+|\s-+\s|\b(?:but|although|though|however|because|while|yet|and (?=(?:i|you|we|he|she|it|they|my|your|our)\b))",
    re.IGNORECASE,
)
_CONDITION = re.compile(r"\b(?:if|unless|whether)\b", re.IGNORECASE)
_ASKED = frozenset({"affection", "astonishing"})
"""Feelings that a question may show: "can I hug you?", "really?"."""


def feelings(sentences: Sequence[str], names: Collection[str] = ()) -> dict[str, Match]:
    """Return the feelings in the sentences of an utterance, each with the clause that shows it best.

    Args:
        sentences: The sentences, in the normal form.
        names: The agent's names: "Rosie is clever" means the same as "you are clever".
    """
    matcher = bundled_matcher("feelings")
    found: dict[str, Match] = {}
    for sentence in sentences:
        sentence = addressed(sentence, names)
        whole = matcher.match_all([sentence])
        parts = [] if _CONDITION.search(sentence) else _clauses(sentence, alone=whole == [None])
        for match in (*whole, *matcher.match_all(parts)):
            if match is None or (match.name not in _ASKED and _asks(sentence)):
                continue
            if match.name == "astonishing" and match.score < SURE and "?" in sentence:
                continue  # a plain question
            if match.name not in found or found[match.name].score < match.score:
                found[match.name] = match
    return found


def clauses(sentences: Sequence[str], names: Collection[str] = ()) -> list[str]:
    """Return all texts that `feelings` may compare with the examples: the sentences and their clauses."""
    spoken = [addressed(sentence, names) for sentence in sentences]
    return [*spoken, *(clause for sentence in spoken for clause in _clauses(sentence, alone=False))]


def _clauses(sentence: str, alone: bool) -> list[str]:
    """Return the clauses of a compound sentence; if `alone`, only those of at least `SHORTEST` words.

    `alone` says that the sentence as a whole shows no feeling.
    """
    parts = [part for part in _CLAUSE_END.split(sentence) if plain(part)]
    least = SHORTEST if alone else 1
    return [part for part in parts if len(part.split()) >= least] if len(parts) > 1 else []


def _asks(sentence: str) -> bool:
    """Return whether a sentence is a yes/no question. The examples decide whether other questions show a feeling."""
    return "?" in sentence and shape(plain(sentence))[3] < 2
