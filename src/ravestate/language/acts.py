"""The user's acts in an utterance: greeting, thanks, a wish for quiet... The classes are those of ``acts.yaml``."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from .matcher import Match, Matcher, bundled_matcher
from .normal import plain

LONGEST = 1000
"""The characters of a sentence that count."""

COURTESY = frozenset({"thanks", "acknowledgement", "apology", "wish"})
"""Acts that accompany others: "thanks, bye", "okay, hello"."""
FORMULAS = frozenset({"greeting", "farewell", *COURTESY})
"""Acts whose short examples may stand before other words: "hello, what is your name", "thank you and goodbye"."""
FORMULA_WORDS = 4
"""The maximum number of words of such an example."""
ADDRESS_WORDS = 3
"""The number of other words that make no more of a greeting: "hello my dear robot"."""

_PAUSE = re.compile(r"[,;:()–—…]+|\s-+\s")
_SUBJECTS = frozenset(["i", "you", "he", "she", "it", "we", "they"])
_LINKS = frozenset(["and", "then", "now", "so", "but"])
_GOES_ON = frozenset(
    ["is", "was", "are", "were", "be", "means", "of", "for", "to", "that", "which", "by", "in", "on", "at", "s"]
)
"""Words that make a formula the beginning of a sentence: "thanks to the rain", "hello is a song"."""
_ASKS = frozenset(
    [
        "what",
        "who",
        "whom",
        "whose",
        "which",
        "where",
        "when",
        "why",
        "how",
        "do",
        "does",
        "did",
        "are",
        "am",
        "have",
        "has",
        "had",
        "can",
        "could",
        "will",
        "would",
        "shall",
        "should",
        "may",
        "might",
    ]
)


def acts(sentences: Sequence[str]) -> dict[str, Match]:
    """Return the acts of the sentences of an utterance, each with its best sentence.

    Until the matcher of the acts is loaded, its examples count word for word.

    Example:
        >>> sorted(acts(["Thanks, bye!"]))
        ['farewell', 'thanks']
    """
    found: dict[str, Match] = {}
    for sentence in sentences:
        for match in _Sentence(sentence).acts:
            if match.name not in found or match.score > found[match.name].score:
                found[match.name] = match
    return found


def only(act: str, sentences: Sequence[str]) -> bool:
    """Return whether an utterance has the act `act` and little else: courtesies and a few other words.

    Example:
        >>> only("greeting", ["Hello, my dear robot!"]), only("greeting", ["Hello, who are you?"])
        (True, False)
    """
    parts = list(map(_Sentence, sentences))
    names = {match.name for part in parts for match in part.acts}
    if act not in names or names - COURTESY - {act}:
        return False
    others = [word for part in parts for word in part.others]
    return len(others) <= ADDRESS_WORDS and not (others and ("?" in sentences[-1] or others[0] in _ASKS | _SUBJECTS))


class _Sentence:
    """The acts of a sentence, and the words that belong to none."""

    def __init__(self, sentence: str) -> None:
        matcher = bundled_matcher("acts")
        sentence = sentence[:LONGEST]
        formulas: dict[str, Match] = {}
        self.others: list[str] = []
        for part in _PAUSE.split(sentence):
            self.others += _after_formulas(matcher, plain(part).split(), formulas)
        whole = matcher.match(sentence)
        if whole is not None and not formulas:
            self.others = []
        found = ([whole] if whole is not None else []) + [
            m for m in formulas.values() if whole is None or m.name != whole.name
        ]
        if len(found) > 1 or self.others:
            found = [match for match in found if match.name != "acknowledgement" or match is whole]
        self.acts: Sequence[Match] = found


def _after_formulas(matcher: Matcher, words: list[str], found: dict[str, Match]) -> list[str]:
    """Add the formulas at the beginning to `found`; return the words after them."""
    while words:
        size = _formula(matcher.exact, words)
        if not size:
            break
        text, words = " ".join(words[:size]), words[size:]
        name = matcher.exact[text]
        found.setdefault(name, Match(1.0, text, 1.0, name=name, text=text))
        while words and words[0] in _LINKS:
            words = words[1:]
    return words


def _formula(examples: Mapping[str, str], words: list[str]) -> int:
    """Return the number of words of the longest formula at the beginning; 0 for none."""
    if words[0] in _SUBJECTS:
        return 0
    for size in range(min(FORMULA_WORDS, len(words)), 0, -1):
        if examples.get(" ".join(words[:size])) in FORMULAS and not (
            words[size : size + 1] and words[size] in _GOES_ON
        ):
            return size
    return 0
