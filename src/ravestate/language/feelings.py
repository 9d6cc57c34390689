"""What an utterance says of feelings: joy, grief, a compliment for the agent... The classes are those of ``feelings.yaml``."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from .matcher import Match, bundled_matcher
from .normal import plain

LONGEST = 1000
"""The characters of a sentence that count."""

_CLAUSE_END = re.compile(
    r"[,;:()–—…]+|\s-+\s|\b(?:but|although|though|however|because|while|yet|and (?=(?:i|you|we|he|she|it|they|my|your|our)\b))",
    re.IGNORECASE,
)
_CONDITION = re.compile(r"\b(?:if|unless|whether)\b", re.IGNORECASE)
_DENIALS = frozenset(
    [
        "not",
        "never",
        "no",
        "nobody",
        "none",
        "nothing",
        "nowhere",
        "neither",
        "nor",
        "hardly",
        "barely",
        "scarcely",
        "cannot",
        "without",
    ]
)
_ASKED = frozenset({"affection", "astonishing"})
"""Feelings that a question may show: "can I hug you?", "really?"."""

_ENDINGS = (
    (r"(?:'s| is| was)(?= (?:so|very|really|such|quite|a|an|the|not)\b)", "you are"),
    (r" (?:is|was)\b", "you are"),
    (r" has\b", "you have"),
    (r"'s\b", "your"),
    (r"\b", "you"),
)
"""The ends of the agent's name, and the words for both."""


def feelings(sentences: Sequence[str], names: Collection[str] = ()) -> dict[str, Match]:
    """Return the feelings in the sentences of an utterance, each with its best clause.

    Args:
        sentences: The sentences, in the normal form.
        names: The agent's names: "Rosie is clever" means the same as "you are clever".
    """
    matcher = bundled_matcher("feelings")
    found: dict[str, Match] = {}
    for sentence in sentences:
        sentence = addressed(sentence[:LONGEST], names)
        clauses = [] if _CONDITION.search(sentence) else [c for c in _CLAUSE_END.split(sentence) if plain(c)]
        for match in matcher.match_all([sentence, *(clauses if len(clauses) > 1 else ())]):
            if match is None or (match.name in found and found[match.name].score >= match.score):
                continue
            if _denied(match.text) != _denied(match.example) or ("?" in sentence and match.name not in _ASKED):
                continue
            found[match.name] = match
    return found


def _denied(text: str) -> bool:
    return not _DENIALS.isdisjoint(plain(text).split())


def addressed(sentence: str, names: Collection[str]) -> str:
    """Return the sentence with "you" in place of the agent's names and "this robot".

    Example:
        >>> addressed("Rosie's voice is nice, and this robot is clever", ["Rosie"])
        'your voice is nice, and you are clever'
    """
    agent = "|".join(["th(?:is|at) (?:little |cute )?robot", *(re.escape(name) for name in names if name)])
    for ending, instead in _ENDINGS:
        sentence = re.sub(rf"(?<!\w)(?:{agent}){ending}", instead, sentence, flags=re.IGNORECASE)
    return sentence
