"""Recognise compliments: kind words about the agent, its acts or its parts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from .patterns import IMAGINED, STRENGTH
from .sentiment import polarity, valence
from .utterance import is_denied

KIND = 1.5
"""The minimum valence of a word of praise."""

SPOILT = -0.1
"""The polarity that spoils a compliment: "nice and stupid"."""

NO_PRAISE = re.compile(
    "welcome|free|sure|safe|ready|fine|okay|ok|right|alright|interested|certain|alive|like|likely|able|"
    "lucky|happy|glad|excited|better|busy|joking|kidding|laughing|true|sorry|please|thanks|thank|playing|"
    "play|rich|party|dear|merry|pleased|calm|relaxed|satisfied|friends|friend|love|wanted|winning|help|"
    "helping|hoping|agreed|respected|sharing"
)
"""Words that VADER calls positive and that are not compliments after "you are"."""

PRAISE_TOO = re.compile(
    "polite|patient|witty|genius|star|legend|gem|hero|pro|champion|expert|clever|smart|wise|quick|"
    "eloquent|knowledgeable|attentive|gifted|skilled|skilful|educated|considerate|classy|stylish|cool|"
    "unique|angel|wonder|professional|humorous|interesting|special|artist|poet|good|well|incredible|"
    "extraordinary|remarkable|favourite|favorite|unbelievable|lifelike|warm"
)
"""Words of praise that VADER does not know or underrates."""

AFTER_PRETTY = {"", "and", "today", "tonight", "in", "with", "when", "robot", "girl"}
"""The words after a "pretty" that does not mean "quite"."""

NO_GOOD = {"to", "for", "enough", "luck"}
"""The words after a "good" that is not praise: "you are good to go"."""

WINDOW = 7
"""The number of words that may hold the praise."""

_SKIPPED = re.compile(rf"(?:{STRENGTH}|much|far|way|at|in|of|and|to|doing|playing|with)")

_DOES = re.compile(
    rf"\byou (?:(?:{STRENGTH}|can|did) )*?(?:sing|sang|talk|speak|spoke|play|played|dance|danced|explain|explained|tell|told|did|do|"
    r"made|make|draw|write|wrote|cook|work|worked|listen|move|answer|answered|say|said|give|gave|remember|learn|understand|"
    r"behave|behaved|handled|solved|know) (.+)"
)
_OTHERS = tuple(
    re.compile(pattern)
    for pattern in (
        rf"\byou (?:(?:{STRENGTH}|can|will|may) )*?(?:are|were|look|looked|sound|sounded|seem|seemed|smell|have|got) "
        r"(?:got |being |getting )?(.+)",
        r"\byour (?!own\b)\w+(?: \w+){0,2}? (?:is|are|was|were|looks?|sounds?|seems?|smells?) (.+)",
        r"(\w+) of you(?: to\b.*)?$",
        r"^(?:(?:what|such|that|it|this|you)(?: is| was)? )?(.+ (?:robot|bot|machine|assistant|computer|listener|singer|teacher|"
        r"girl|boy|answer|reply|joke|job|work|one|point|explanation|question|idea|voice|poem|company|advice|memory))"
        r"(?: (?:you|i|ever|of|for|from|in)\b.*)?$",
        r"\bwhat (?:a |an )?(.+) you (?:have|are)$",
        r"\bhow (\w+) (?:you are|you look|you sound|your \w+ (?:is|are))",
        r"\bi (?:find|consider|call) you (.+)",
    )
)


def is_praise(clause: str) -> bool:
    """Return whether a normalised clause is a compliment to the agent."""
    for pattern in (_DOES, *_OTHERS):
        found = pattern.search(clause)
        if (
            found is not None
            and not IMAGINED.search(clause[: found.start()])
            and not is_denied(clause, found.end())
            and _begins_kindly(found[1].split(), does=pattern is _DOES)
            and polarity(found[1]) > SPOILT
        ):
            return True
    return False


def is_kind(word: str) -> bool:
    """Return whether `word` is praise."""
    return not NO_PRAISE.fullmatch(word) and any(
        PRAISE_TOO.fullmatch(form) or valence(form) >= KIND for form in (word, *_stems(word))
    )


def _begins_kindly(words: Sequence[str], *, does: bool) -> bool:
    """Return whether the first word that counts is kind. For an act (`does`), any of the first words may be."""
    for word, after in zip(words[:WINDOW], (*words[1:], ""), strict=False):
        if (word == "pretty" and after not in AFTER_PRETTY) or (word == "kind" and after == "of"):
            continue  # "pretty clever", "kind of slow"
        if word == "good" and after in NO_GOOD:
            return False
        if word == "well":
            return does
        if is_kind(word) or (after == "than" and any(map(is_kind, (word[:-1], word[:-2])))):
            return True
        if not (does or _SKIPPED.fullmatch(word)):
            return False
    return False


def _stems(word: str) -> Iterable[str]:
    if word.endswith("iest"):
        yield word[:-4] + "y"
    elif word.endswith("est"):
        yield from (word[:-3], word[:-2])
    elif word.endswith("bly"):
        yield word[:-1] + "e"
    elif word.endswith("ly"):
        yield word[:-2]
