"""Words around an answer: short forms, and openings such as *no* or *sorry*."""

from __future__ import annotations

import re

from .topics import WORDS


def _any(name: str) -> str:
    """Return a pattern that matches any phrase of a list in `WORDS`."""
    return "|".join(map(re.escape, sorted(WORDS[name], key=len, reverse=True)))


_CORRECTIONS = re.compile(rf"^\W*(?:(?:{_any('corrections')})(?![\w'])[\s,.:;!…-]*)+", re.IGNORECASE)


def spelled_out(text: str) -> str:
    """Return a text with its short forms written out: *it's* as *it is*."""
    for form, full in ((r"n['’]t\b", " not"), (r"['’]m\b", " am"), (r"['’]re\b", " are"), (r"['’]d\b", " would")):
        text = re.sub(form, full, text)
    return re.sub(r"\b(it|that|he|she|there|name)['’]s\b", r"\1 is", text, flags=re.IGNORECASE).strip()


def without_opening(text: str) -> str:
    """Return the words after *no*, *sorry* and the like; empty if a text has no such opening, or is an idiom (*no problem*)."""
    opening = _CORRECTIONS.match(text)
    rest = text[opening.end() :] if opening else ""
    return "" if not rest or rest.lower().split()[0].strip(",.!") in WORDS["idioms"] else rest
