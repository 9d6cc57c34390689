"""Correct typos by means of known words."""

from __future__ import annotations

from collections.abc import Iterable

SHORTEST = 6
"""The minimum length of a word to correct: too many other words resemble shorter ones."""


class Slips:
    """A set of known words that corrects misspelt ones.

    Example:
        >>> Slips(["siblings", "friends"]).mended("do you have frends")
        'do you have friends'
    """

    def __init__(self, words: Iterable[str]) -> None:
        self._words = frozenset(words)
        self._long = sorted(word for word in self._words if len(word) >= SHORTEST)

    def mended(self, text: str) -> str:
        """Return `text` with each unknown word replaced by a known word one typo away, if there is exactly one.

        A typo is a letter missing, doubled or wrong, or two letters swapped. The first letter must be right."""
        return " ".join(self._meant(word) for word in text.split())

    def _meant(self, word: str) -> str:
        if word in self._words or len(word) < SHORTEST - 1:
            return word
        near = [known for known in self._long if known[0] == word[0] and _one_slip(word, known)]
        return near[0] if len(near) == 1 else word


def _one_slip(word: str, known: str) -> bool:
    if abs(len(word) - len(known)) > 1:
        return False
    begin = 0
    while begin < min(len(word), len(known)) and word[begin] == known[begin]:
        begin += 1
    rest, wanted = word[begin:], known[begin:]
    return (
        rest[1:] == wanted  # one too many
        or rest == wanted[1:]  # one missing
        or rest[1:] == wanted[1:]  # one wrong
        or (rest[:2] == wanted[1::-1] and rest[2:] == wanted[2:])  # two exchanged
    )
