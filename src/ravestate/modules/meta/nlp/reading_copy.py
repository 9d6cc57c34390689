"""What the pipeline reads in place of the text: as long as it, character for character, but easier to read."""

from __future__ import annotations

import re

__all__ = ["READ_AS", "reading_copy"]

READ_AS = {"need": "like"}
"""Words of the copy that stand for others of the text, as lemmas. *like* is taken for a preposition all too often, in
short sentences above all; another verb in its place is not."""

# Control characters, and halves of characters, which cannot be encoded.
_UNREADABLE = dict.fromkeys((*range(0x20), *range(0x7F, 0xA0), *range(0xD800, 0xE000)), " ")
_LIKES = re.compile(
    r"(?:\b(?:i|you|we|they|who|to|not|really|also|always|never|would|do|does|both|people|"
    r"(?:do|does|did|don't|doesn't|didn't|and) (?:(?:my|your|his|her|the|their|our) )?\w+)|"
    r"n['’]?t|['’]d) (?P<like>like)(?! (?:that|this)\s*[.!?]*$)\b",
    re.IGNORECASE,
)


def reading_copy(text: str) -> str:
    """Return the copy of `text`.

    Example:
        >>> reading_copy("do you like\\x00it?")
        'do you need it?'
    """
    copy = text.translate(_UNREADABLE).replace("’", "'")
    for found in _LIKES.finditer(copy):
        start, end = found.span("like")
        copy = copy[:start] + "need" + copy[end:]
    return copy
