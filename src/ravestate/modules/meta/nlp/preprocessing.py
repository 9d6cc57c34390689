"""Prepare a text for the pipeline; every character keeps its position."""

from __future__ import annotations

import re

from ravestate.language.asides import asides

READ_AS = {"have": "like", "stay": "live", "stays": "live", "teaches": "study"}
"""A replacement → the lemma of the word that it replaces. In short sentences, the small pipelines often mistake *like*
for a preposition, and *lives* and *studies* for nouns. They handle *have*, *stays* and *teaches* correctly."""

# Control characters, and surrogates, which cannot be encoded.
_UNREADABLE = dict.fromkeys((*range(0x20), *range(0x7F, 0xA0), *range(0xD800, 0xE000)), " ")
_LIKES = re.compile(
    r"\b(?:i|you|we|they|who|to|really|also|always|never|(?:do|does|did|would|will|can) not|would|do|does|both|most people|"
    r"(?:do|does|don't|doesn't|didn't|wouldn't|can't|i'd|you'd|he'd|she'd|we'd|they'd)|"
    r"(?:do|does|did|don't|doesn't|didn't|and) (?:(?:my|your|his|her|the|their|our) )?"
    r"(?!(?:look|feel|sound|seem|taste|smell|act|is|was|are|people|someone|something|things|just)\b)\w+) "
    r"(?P<verb>like)\b(?! (?:that|this)\s*[.!?]*$)"
    # "My friends like", but not "friends like you"
    r"|(?:^|[.!?] )(?:(?:my|our|his|her|their|your|the|most|many|some|all) )?(?:\w+s|children|people|men|women) "
    r"(?P<plural>like)\b(?! (?:you|me|him|her|us|them|this|that|these|those)\b)",
    re.IGNORECASE,
)
_LIVES = re.compile(
    r"(?<!\bmy )(?<!\bour )(?<!\bhis )(?<!\bher )(?<!\btheir )(?<!\byour )(?<!\bthe )(?<!\bof )\blives?(?= (?:in|at|near|with|"
    r"here|there|alone|on|abroad|together|next)\b)",
    re.IGNORECASE,
)
_STUDIES = re.compile(
    r"(?<!\bmy )(?<!\bour )(?<!\bhis )(?<!\bher )(?<!\btheir )(?<!\byour )(?<!\bthe )(?<!\bof )(?<!\bfor )(?<!\bcase )"
    r"(?<=[a-z] )studies(?= (?!(?:are|were|have|show|suggest|say|find|and|on|of|is|was)\b)\w)"
)
_NO_WAIT = re.compile(r"(?:^|(?<=[.!?,;] ))no(?= wait,)", re.IGNORECASE)
"""The *no* of *no wait, my name is Alice*: the parser would take it for a negation."""


def preprocess(text: str) -> str:
    """Return `text` with some words replaced by words of the same length, and asides and control characters by spaces.

    Example:
        >>> preprocess("do you like\\x00it?")
        'do you have it?'
    """
    copy = text.translate(_UNREADABLE).replace("’", "'")
    for start, end in [*asides(copy)]:  # the parser would take "lol" for a noun
        copy = copy[:start] + " " * (end - start) + copy[end:]
    for found in _LIKES.finditer(copy):
        start, end = found.span(found.lastgroup or 0)
        copy = copy[:start] + "have" + copy[end:]
    copy = _STUDIES.sub("teaches", copy)
    copy = _NO_WAIT.sub("oh", copy)
    return _LIVES.sub(lambda found: "stays" if found[0].lower() == "lives" else "stay", copy)
