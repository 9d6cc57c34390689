"""Recognise texts that come from hitting the keyboard at random."""

from __future__ import annotations

import re
import unicodedata

from .lexicon import loaded_lexicon

_WORD = re.compile(r"[^\W\d_]+")
_MASHED = re.compile(r"(.)\1{3}|qwe|wert[yz]|asd(?:asd|[^aeiouyr]|$)|sdf|dfg|(?<!a)fgh|ghj|hjk|jkl|zxc|xcv|cvb|yxc")
"""Letters that stand side by side on a keyboard, and rarely in a word. *Antwerp*, *Jasdeep* and *Afghan* are words."""
_DIGRAPH = re.compile(r"sch|[cgpst]h")
"""Letters that count as one consonant: *Knightsbridge* and *Hirschsprung* are words."""
_CONSONANTS = re.compile(r"[^aeiouy]{6}")
_NO_VOWEL = re.compile(r"[^aeiouy]{4,}")


def is_nonsense(text: str) -> bool:
    """Return whether a text looks as if the keyboard was hit at random.

    Example:
        >>> is_nonsense("asdfgh jkl"), is_nonsense("hello there")
        (True, False)
    """
    words = _WORD.findall(text)
    letters = sum(map(len, words))
    return bool(words) and sum(map(len, filter(_is_mashed, words))) > letters / 2


def _is_mashed(word: str) -> bool:
    """Return whether a word has a row of letters that no word of a Latin alphabet has.

    Other alphabets are not judged, and neither are the words of the lexicon, if it is loaded.
    """
    letters = unicodedata.normalize("NFD", word.lower())
    plain = "".join(letter for letter in letters if not unicodedata.combining(letter))
    lexicon = loaded_lexicon()
    if len(plain) < 4 or not plain.isascii() or (lexicon is not None and lexicon.known(plain)):
        return False
    initials = word.isupper() and len(word) < 6  # "HSBC"
    accented = plain != letters  # "Smrž"
    vowelless = _NO_VOWEL.fullmatch(plain) and not initials and not accented
    return bool(vowelless or _MASHED.search(plain) or _CONSONANTS.search(_DIGRAPH.sub("h", plain)))
