"""The values of facts about the user: the words that can be a value, and memory's spelling of a value.

A fact has a topic, such as *hobby*, and values, such as *chess*.
"""

from __future__ import annotations

import contextlib
import re
import unicodedata

from ravestate.modules import nlp

from .topics import Topic
from .wording import tidy

LONGEST = {"name": 4, "people": 4, "place": 5}
"""Kind → the maximum number of words of a value; 7 words for all other kinds."""
_LEADS = {
    **dict.fromkeys(("subject", "activity", "thing"), r"an? (?=\S)"),
    "work": r"(?:an?|the) (?=\S)",
    "place": r"(?:the )?(?:city|town|village) of (?=\S)|.*\b(?:called|named) (?=\S)",
}
"""Words that stand before a value and do not belong to the value."""
_DEICTIC = re.compile(
    r"(?:this|that|these|those|it|you|him|her|them|me|us|here|there|(?:any|some|every|no)(?:thing|one|body|where)|none|no)",
    re.IGNORECASE,
)
_DOUBLING = re.compile(r"(?:(?:be|re|de|ad|for|up)(?=[^aeiou]))?[^aeiou]*[aeiou][bdgmnpt]|quit")
"""Verbs with a stressed last syllable, which double their last letter: *run*, *begin*, but not *visit*."""


def value_of(text: str, topic: Topic, seen: nlp.Analysis) -> str | None:
    """Return some words as a value in memory's spelling; None if they cannot be a value of the topic.

    Args:
        text: The words.
        topic: The topic.
        seen: The analysis of the utterance.
    """
    kind = topic.kind
    text = re.sub(f"^(?:{_LEADS.get(kind, '')})", "", _trimmed(text), flags=re.IGNORECASE)
    words = text.lower().split()
    if not words or len(text) > 60 or len(words) > LONGEST.get(kind, 7):
        return None
    if kind != "name" and _DEICTIC.fullmatch(text):
        return None
    if text.lower() in topic.nouns:  # "I go to university"
        return None
    if kind == "number":
        parts = (number_in(" ".join(words[:size])) for size in range(len(words), 0, -1))  # "seven and a half"
        number = next(filter(None, parts), "0")
        return number if 0 < int(number) < 120 else None
    if not any(unicodedata.category(letter)[0] == "L" or unicodedata.category(letter) == "So" for letter in text):
        return None
    named = kind in ("name", "people")
    return tidy(gerund(text, seen) if kind == "activity" else _typed(text, seen) if named else text, topic)


def _typed(name: str, seen: nlp.Analysis) -> str:
    """Return a name as the user typed it, if the normal form has changed it as if it were a typing error."""
    at = seen.normal.text.lower().find(name.lower())
    start, end = seen.normal.span(at, at + len(name)) if at >= 0 else (0, 0)
    typed = seen.normal.original[start:end]
    same = typed.lower() == name.lower() or len(typed) > 60
    return name if same or not typed.replace(" ", "").isalpha() else typed


def number_in(text: str) -> str:
    """Return a whole number in digits: *7* for *seven*; empty for other words."""
    if text.isdecimal():
        return str(int(text))
    import text_to_num  # pyright: ignore[reportMissingTypeStubs]

    with contextlib.suppress(ValueError):
        return str(text_to_num.text2num(text.lower(), "en"))  # pyright: ignore[reportUnknownArgumentType, reportUnknownMemberType]
    return ""


def _trimmed(text: str) -> str:
    """Return a text without the punctuation and the emoji around it. A text of emoji alone stays."""
    kinds = [unicodedata.category(letter)[0] for letter in text]
    kept = [at for at, letter in enumerate(text) if kinds[at] in "LN" or letter in "+#"]
    while kept and kinds[kept[-1] + 1 :][:1] == ["M"]:  # a sign on the last letter, such as a vowel of Hindi
        kept.append(kept[-1] + 1)
    return text[kept[0] : kept[-1] + 1] if kept else text.strip(" \"'.,;:!?-_*~()[]{}<>|“”„«»…`\n")


def gerund(text: str, seen: nlp.Analysis) -> str:
    """Return a verb phrase in the form of a hobby: *reading books* for *read books*."""
    verbs = {word.low for word in seen.tree.words if word.pos in ("VERB", "AUX")}

    def turned(found: re.Match[str]) -> str:
        verb = found[2].lower()
        if verb.endswith("ing") or (not found[1] and verb not in verbs):
            return found[2]
        if _DOUBLING.fullmatch(verb):
            return f"{verb}{verb[-1]}ing"
        return re.sub(r"(?<!e)e$", "", verb) + "ing"

    text = re.sub(r"^(?:to )?go (?=[a-z]{2,}ing\b)", "", text)  # "go swimming"
    return re.sub(r"^(to )?(\w+)", turned, text)
