"""Find asides, which add nothing to a statement: *lol* in *I painted a dragon lol*, *to be honest* in *I like it, to be honest*."""

from __future__ import annotations

import re
from collections.abc import Iterator

LAUGHTER = r"(?:lol|lmao|rofl|ha(?:ha)+h?|he(?:he)+|hihi)"
"""A regular expression for a word of laughter."""
_FRANKLY = r"to be honest"
_NAMED = (
    r"(?:an?|the|this|that|my|your|and|or|of|in|at|for|with|about|to|from|as|than|is|are|was|were|be|been|being|'?s|"
    r"call(?:s|ed)?|named?|says?|said|saying|means?|meant|meaning|wr[io]tes?|writing|types?|typed|words?|play(?:s|ed|ing)?)"
)
"""Words before a *lol* that belongs to the statement: *he said lol*, *what does it mean? It means lol*, *we play LoL*."""
_END = r"(?=\s*(?:[.!?…;]|$))"
_SUBJECT = r"(?:i|i['’]\w+|you|we|he|she|it|they|my|our|your|his|her|their|the|there|this|that)\b"
_ASIDES = tuple(
    re.compile(aside, re.IGNORECASE)
    for aside in (
        rf"\b(?!(?:{_NAMED}|{LAUGHTER})\b)[^\W_][\w'’-]*(?P<aside>(?:[,\s]+{LAUGHTER})+){_END}",
        rf"(?:^|(?<=[.!?]\s))(?P<aside>(?:{LAUGHTER}\s+)+)(?={_SUBJECT}|(?-i:[A-Z][a-z]))",
        rf"(?P<aside>,\s+{_FRANKLY}){_END}",
        rf"(?:^|(?<=[.!?]\s))(?P<aside>{_FRANKLY},\s+)",
    )
)


def asides(text: str) -> Iterator[tuple[int, int]]:
    """Yield the places of the asides in a text, with the white space and the comma before or after them.

    Example:
        >>> [text[start:end] for text in ["I painted a dragon lol."] for start, end in asides(text)]
        [' lol']
        >>> list(asides("My dog is called Lol."))
        []
    """
    for aside in _ASIDES:
        for found in aside.finditer(text):
            yield found.span("aside")
