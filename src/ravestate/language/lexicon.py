"""The words of English: common words and names.

The first use loads the data from two packages. *pyspellchecker* has the frequencies of words in subtitles, and proposes
corrections. Hunspell's English dictionary, a file in *spylls*, has names with their capitals.
"""

from __future__ import annotations

import calendar
import logging
import re
import threading
from functools import lru_cache
from importlib.util import find_spec
from itertools import islice, pairwise, product
from pathlib import Path
from typing import Any

from .contractions import word_set

FREQUENT = 5000
"""The minimum count, in subtitles of 1.6 billion words, of a word that replaces an unknown word."""
COMMON = 15_000
"""A word that may be a name is taken for an ordinary word if its count in lower case is at least this."""
RARE = 50
"""A word is rare if its count is at most this, and it is not an ordinary word of the dictionary."""
DOUBLED = 20
"""The factor by which swapped and doubled letters are more frequent than other typing errors."""
SHORTEST = 4
"""The minimum length, in letters, of a word that may be a typing error."""

_BRITISH = [
    pair.split("/")
    for pair in [
        "our/or",
        "tre/ter",
        "lled/led",
        "lling/ling",
        "ller/ler",
        "is/iz",
        "ys/yz",
        "gue/g",
        "ce/se",
        "que/ck",
    ]
]
"""British and American spellings. British spelling is not a typing error."""
_BRITISH_WORDS = word_set("maths programme programmes dreamt")
"""Words of British English that are missing from both packages."""
_NO_NAMES = word_set(
    "grey armour tyre honorable mister independence reunion reconstruction que les del mon dem herr san"
)
"""Words that the dictionary lists as names, but that are more often ordinary words."""

_RUN = re.compile(r"(.)\1*")
_STRETCHED = re.compile(r"(.)\1\1")
_log = logging.getLogger("ravestate.language")
_lock = threading.Lock()
_loaded: list[Lexicon | None] = []


def load_lexicon() -> Lexicon | None:
    """Load and return the shared lexicon; None if its packages are not installed. The first call takes about 0.3 s."""
    with _lock:
        if not _loaded:
            try:
                _loaded.append(Lexicon())
            except ImportError as error:
                _log.info("typing errors are not corrected: pip install 'ravestate[nlp]' (%s)", error)
                _loaded.append(None)
    return loaded_lexicon()


def loaded_lexicon() -> Lexicon | None:
    """Return the shared lexicon; None if it is not loaded."""
    return _loaded[0] if _loaded else None


class Lexicon:
    """Words of English, in lower case, and names."""

    def __init__(self) -> None:
        """Load the data.

        Raises:
            ImportError: A package is missing.
        """
        from spellchecker import SpellChecker

        self._speller: Any = SpellChecker(language="en", distance=1)
        self._counts: dict[str, int] = self._speller.word_frequency.dictionary
        self._ordinary, self._names, self._ambiguous = _dictionary()
        self.correction = lru_cache(maxsize=4096)(self._correction)

    def count(self, word: str) -> int:
        """Return the count of `word` in lower case, per 1.6 billion words."""
        return self._counts.get(word, 0)

    def known(self, word: str) -> bool:
        """Return whether `word`, in lower case, is a word or a name."""
        return word in self._counts or word in self._ordinary or word in self._names or word in _BRITISH_WORDS

    def rare(self, word: str) -> bool:
        """Return whether `word`, in lower case, is no ordinary word of the dictionary and hardly occurs in subtitles."""
        return word not in self._ordinary and self.count(word) <= RARE

    def name(self, word: str) -> str:
        """Return `word`, with a capital if it is a name."""
        return self._names.get(word, word)

    def possible_name(self, word: str) -> str:
        """Return `word`, with a capital if it is both a name and an uncommon ordinary word: *Tom*."""
        name = self._ambiguous.get(word)
        return name if name and self.count(word) < COMMON else word

    def unstretched(self, word: str) -> str:
        """Return `word` without the letters that were repeated for emphasis: *so* for *sooo*."""
        if not _STRETCHED.search(word):
            return word
        runs = [run[0] for run in _RUN.finditer(word[:24])]
        choices = [(run[0], run[:2]) if len(run) > 2 else (run,) for run in runs]
        shapes = ["".join(parts) for parts in islice(product(*choices), 64)]
        return max(shapes, key=self.count) if any(map(self.count, shapes)) else word

    def _correction(self, word: str) -> str:
        """Return the frequent word that the user probably meant by an unknown `word`. If there is none, return `word`.

        In a short word, which resembles many others, only swapped, doubled and missing letters are mended.
        """
        known = self.known(word) or (word.endswith("s") and self.known(word[:-1]))
        if len(word) < SHORTEST or not word.isalpha() or not word.isascii() or known:
            return word
        if not all(map(self.rare, _american(word))):
            return word
        near = [other for other in self._speller.known(self._speller.edit_distance_1(word)) if self._slip(word, other)]
        letters = set(word)
        best = max(near, key=lambda near: self.count(near) * (DOUBLED if set(near) == letters else 1), default=word)
        return best if self.count(best) >= FREQUENT else word

    @staticmethod
    def _slip(word: str, other: str) -> bool:
        """Return whether `word` is a likely typing error for `other`.

        In a short word, only swapped, doubled and missing letters count. The first letter may be wrong only if letters
        are swapped.
        """
        if other[0] != word[0] and sorted(other) != sorted(word):
            return False
        if len(word) == len(other):
            return len(word) > SHORTEST or sorted(word) == sorted(other)
        if len(word) > len(other):  # a letter too many: in a short word, this must be a doubled letter
            return len(word) > SHORTEST + 1 or any(a == b for a, b in pairwise(word))
        return True


def _american(word: str) -> set[str]:
    """Return American spellings of a word, each with one British letter group replaced: *apologize* for *apologise*."""
    return {word.replace(british, american, 1) for british, american in _BRITISH} - {word}


def _dictionary() -> tuple[frozenset[str], dict[str, str], dict[str, str]]:
    """Return the dictionary's ordinary words, the names, and the dictionary's words that are both.

    Names have keys in lower case. The names are those of the dictionary, together with days and months. They are
    without ordinary words, the plurals of ordinary words, and `_NO_NAMES`.
    """
    spec = find_spec("spylls")
    if spec is None or spec.origin is None:
        raise ImportError("No module named 'spylls'")
    lines = (Path(spec.origin).parent / "hunspell" / "data" / "en" / "en_US.dic").read_text("latin-1").splitlines()
    entries = [line.partition("/")[0].strip() for line in lines[1:]]
    ordinary = frozenset(entry for entry in entries if entry.islower())
    names = {
        entry.lower(): entry
        for entry in entries
        if len(entry) > 2 and entry.isalpha() and entry[0].isupper() and entry[1:].islower()
    }
    # "Weeks" and "Jobs" are names, but more often plurals of ordinary words.
    both = {low: name for low, name in names.items() if low in ordinary}
    others = _NO_NAMES | ordinary
    names = {low: name for low, name in names.items() if low not in others and low.removesuffix("s") not in ordinary}
    days = [*calendar.day_name, *(f"{name}s" for name in calendar.day_name)]
    names |= {name.lower(): name for name in (*days, *calendar.month_name) if len(name) > 3 and name != "March"}
    return ordinary, names, both
