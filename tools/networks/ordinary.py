"""Statements of ordinary talk. They are no answers, so they teach the head ``answers`` what is no *yes* and no *no*."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

LEAST, LEAST_OF_I = 4, 8
"""The minimum number of words of a statement, and of one that begins with *I*. Shorter texts may be answers: *I did*."""
_OPENING = re.compile(
    r"\W*(?:ye|yes|yeah|yep|yup|ya|aye|sure|ok|okay|okey|no|nope|nah|not|never|none|maybe|perhaps|probably|possibly|of|course|"
    r"certainly|absolutely|definitely|right|exactly|alright|all|fine|guess|suppose|think|hope|know|idk|dunno|unsure|"
    r"depends|agree|please|thanks|love|rather|kind|sort|a|bit|would|could|might|can|will|do|did|am|is|was|have|has|why|how|what)\b",
    re.IGNORECASE,
)
"""The first word of a text that may be an answer, or a question."""
_INSIDE = re.compile(
    r"\b(?:yes|yeah|yep|no|nope|nah|not really|maybe|perhaps|probably|of course|don'?t know|not sure|idk|dunno|no idea|"
    r"i (?:do|did|am|was|have|would|will|can)(?: not)?[.!]?$)(?!\w)",
    re.IGNORECASE,
)
"""Words inside a text that may be an answer."""


def statements(files: Sequence[Path]) -> list[str]:
    """Return the texts of talks that are surely no answers."""
    lines = (line for file in files for line in file.read_text(encoding="utf-8").splitlines())
    texts = dict.fromkeys(
        line.partition("\t")[0].strip() for line in lines if "\t" in line and not line.startswith("#")
    )
    return [text for text in texts if _is_long(text) and not _OPENING.match(text) and not _INSIDE.search(text)]


def _is_long(text: str) -> bool:
    return len(text.split()) >= (LEAST_OF_I if re.match(r"i\b", text, re.IGNORECASE) else LEAST)
