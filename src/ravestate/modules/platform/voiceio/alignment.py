"""Find out when each written word is spoken, from the times of the spoken words."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

_WORD = re.compile(r"\S+")
_PHONEMES = 0.85
"""The average number of phonemes per letter of a word."""
_DIGIT = 4.0
"""The average number of phonemes in a spoken digit."""
_MOST = 10
"""The maximum number of spoken words for one written word. For example, 1859 is spoken as several words."""


@dataclass(frozen=True, slots=True)
class Word:
    """A word of a text: its place in the text (characters), and when it begins in the sound (seconds)."""

    begin: int
    end: int
    time: float


def places_of(text: str) -> list[tuple[int, int]]:
    """Return the beginning and the end of each word that has a letter or a digit."""
    return [(word.start(), word.end()) for word in _WORD.finditer(text) if any(c.isalnum() for c in word[0])]


def by_places(text: str, found: Sequence[tuple[int, float]], length: float) -> tuple[Word, ...]:
    """Return the words of a text with their times, from the places and times of some of them.

    Args:
        text: The text.
        found: The known places in the text (characters), each with its time (seconds).
        length: The length of the whole sound (seconds).
    """
    places = places_of(text)
    times: dict[int, float] = {}
    for place, time in found:
        at = max((number for number, (begin, _) in enumerate(places) if begin <= place), default=0)
        times.setdefault(at, time)
    return _filled(text, places, times, length)


def by_phonemes(text: str, spoken: Sequence[tuple[float, int]], length: float) -> tuple[Word, ...]:
    """Return the words of a text with their times, from the time and the number of phonemes of each spoken word.

    One spoken word may be several written words ("there was a"), and a written number is several spoken words. The
    function chooses the alignment in which the numbers of phonemes agree best. All times, and the `length` of the
    sound, are in seconds.
    """
    places = places_of(text)
    expected = [_expected(text[begin:end]) for begin, end in places]
    rows, columns = len(places), len(spoken)
    best: dict[tuple[int, int], tuple[float, tuple[int, int]]] = {(0, 0): (0.0, (0, 0))}
    for row in range(rows):
        for column in range(columns):
            if (row, column) not in best:
                continue
            base = best[row, column][0]
            for written, said in _STEPS:
                if row + written > rows or column + said > columns:
                    continue
                want = sum(expected[row : row + written])
                have = sum(count for _, count in spoken[column : column + said])
                cost = base + (want - have) ** 2 / (want + have + 1) + 0.4 * (written + said - 2)
                to = row + written, column + said
                if to not in best or cost < best[to][0]:
                    best[to] = cost, (written, said)
    times: dict[int, float] = {}
    at = rows, columns
    if at not in best:  # the numbers of written and spoken words differ too much, so distribute the words evenly
        for row in range(rows if columns else 0):
            times[row] = spoken[row * columns // rows][0]
        return _filled(text, places, times, length)
    while at != (0, 0):
        written, said = best[at][1]
        at = at[0] - written, at[1] - said
        times[at[0]] = spoken[at[1]][0]
    return _filled(text, places, times, length)


# Pairs: a number of written words, and the number of words that a voice may speak for them.
_STEPS = [(1, said) for said in range(1, _MOST + 1)] + [(2, 1), (3, 1), (4, 1)]


def _expected(word: str) -> float:
    digits = sum(c.isdigit() for c in word)
    return max(1.0, digits * _DIGIT + _PHONEMES * sum(c.isalpha() for c in word))


def _filled(
    text: str, places: Sequence[tuple[int, int]], times: Mapping[int, float], length: float
) -> tuple[Word, ...]:
    """Return all words. A word without a time gets a time between those of its neighbours, according to its place."""
    known = [
        (-1, 0, 0.0),
        *((row, places[row][0], times[row]) for row in sorted(times)),
        (len(places), len(text), length),
    ]
    words: list[Word] = []
    for row, (begin, end) in enumerate(places):
        _, left, early = max(entry for entry in known if entry[0] <= row)
        _, right, late = min(entry for entry in known if entry[0] > row)
        time = early if row in times else early + (late - early) * (begin - left) / max(1, right - left)
        words.append(Word(begin, end, min(max(time, words[-1].time if words else 0.0), length)))
    return tuple(words)
