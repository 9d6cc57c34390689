"""Values of topics: whether words can be one, and how it is written."""

from __future__ import annotations

import re
import unicodedata

from ravestate.modules import nlp

from .kinds import likeness
from .topics import Topic
from .wording import tidy

_DETERMINERS = frozenset(
    [
        "a",
        "an",
        "the",
        "my",
        "your",
        "his",
        "her",
        "our",
        "their",
        "this",
        "that",
        "these",
        "those",
        "it",
        "some",
        "any",
        "no",
        "one",
    ]
)
_FUNCTION = frozenset(
    [
        "i",
        "i'm",
        "me",
        "you",
        "he",
        "she",
        "we",
        "they",
        "it",
        "him",
        "them",
        "us",
        "myself",
        "yourself",
        "is",
        "are",
        "was",
        "were",
        "be",
        "am",
        "do",
        "does",
        "did",
        "has",
        "have",
        "had",
        "will",
        "would",
        "can",
        "could",
        "not",
        "no",
        "what",
        "why",
        "how",
        "when",
        "where",
        "who",
        "if",
        "because",
    ]
)
"""Grammatical words that no value has."""
_DEICTIC = re.compile(
    r"(?:this|that|these|those|it|you|him|her|them|me|us|my|your|here|there|(?:any|some|every|no)(?:thing|one|body))\b",
    re.IGNORECASE,
)
_CLOSED = frozenset(["PRON", "DET", "AUX", "SCONJ", "CCONJ", "PART", "ADV", "INTJ", "VERB", "ADP"])
_PLACES = frozenset(["GPE", "LOC", "FAC", "NORP"])
_TIMES = frozenset(["DATE", "TIME"])
LONGEST = {"name": 4, "people": 4, "place": 5}
DOUBT = {"place": -0.12, "work": -0.02, "organisation": 0.0, "subject": -0.35, "name": 0.12, "people": 0.12}
"""The least likeness of a value to its kind, by kind, where nothing introduces it."""


def value_of(text: str, topic: Topic, seen: nlp.Analysis, *, sure: bool = True) -> str | None:
    """Return a value as it is kept; None if these words cannot be one.

    Args:
        text: The words.
        topic: The topic.
        seen: The analysis of the utterance.
        sure: Whether the words before it introduce this kind: *my name is*, or the agent asked for it.
    """
    text = (
        re.sub(r"^(?:the )?(?:city|town|village) of (?=\S)", "", _trimmed(text), flags=re.IGNORECASE)
        if topic.kind == "place"
        else _trimmed(text)
    )
    text = re.sub(r"\.(?= )|,? (?:any ?(?:more|longer)|too|as well|now)$", "", text, flags=re.IGNORECASE)
    words = text.lower().split()
    if topic.kind in ("work", "subject", "activity", "thing") and len(words) > 1 and words[0] in ("a", "an"):
        text, words = text.split(maxsplit=1)[1], words[1:]
    if topic.kind == "work" and len(words) > 1 and words[0] == "the":
        text, words = text.split(maxsplit=1)[1], words[1:]
    if not words or len(text) > 60 or len(words) > LONGEST.get(topic.kind, 7):
        return None
    if topic.kind == "number":
        return text if text.isdecimal() and 0 < int(text) < 120 else None
    named = topic.kind in ("name", "people")
    if (
        (_FUNCTION | _DETERMINERS if named else _FUNCTION) & set(words[named and words[0] == "will" :])
        or not any(map(_tells, text))
        or text[0].isdigit()
    ):
        return None
    if not _fits(text, words, topic, seen, sure):
        return None
    if topic.kind == "activity":
        text = gerund(text, seen)
    return tidy(text, topic)


def _fits(text: str, words: list[str], topic: Topic, seen: nlp.Analysis, sure: bool) -> bool:
    labels = {entity.label for entity in seen.entities if text.lower() in entity.text.lower()}
    kind = topic.kind
    if labels & _TIMES and not labels & _PLACES and kind in ("place", "organisation", "name", "people"):
        return False
    match kind:
        case "name" | "people":
            if any(letter.isdigit() for letter in text) or re.search(r"['’]s\b", text):
                return False
            if _is_name(text, seen, labels):
                return True
            parts = {word.pos for word in seen.tree.words if word.text in text.split()}
            if not sure and parts & _CLOSED:
                return False
            return likeness(text, kind) > (-0.6 if sure else DOUBT[kind])
        case "place":
            if any(letter.isdigit() for letter in text):
                return False
            if labels & _PLACES:
                return True
            doubt = -0.5 if sure else DOUBT[kind]
            return likeness(text, kind) > (0.0 if words[0] in _DETERMINERS else doubt)
        case "organisation":
            if labels & {"ORG"}:
                return True
            return likeness(text, "club" if topic.name == "club" else kind) > (-0.7 if sure else DOUBT[kind])
        case "work":
            return likeness(text, kind) > (-0.5 if sure else DOUBT[kind]) and words[0] not in _DETERMINERS
        case "subject":
            return likeness(text, kind) > (-0.7 if sure else DOUBT[kind]) and words[0] not in _DETERMINERS
        case _:
            return _DEICTIC.match(text) is None and words[0] not in ("more", "most", "a", "many", "much")


def _is_name(text: str, seen: nlp.Analysis, labels: set[str]) -> bool:
    """Return whether the parse or the capitals make these words a name."""
    mine = [word for word in seen.tree.words if word.text in text.split()]
    if any(word.pos in _CLOSED or word.pos == "ADJ" for word in mine):
        return False
    if "PERSON" in labels:
        return True
    capital = text[:1].isupper() and not text.isupper()
    return capital and not labels and not seen.text.isupper()


def _trimmed(text: str) -> str:
    """Return a text without the punctuation and the emoji around it; an emoji alone stays."""
    text = text.strip(" \"'.,;:!?-_*~()[]{}<>|“”„«»…`\n")
    if any(map(str.isalnum, text)):
        while text and _is_picture(text[-1]):
            text = text[:-1].rstrip()
        while text and _is_picture(text[0]):
            text = text[1:].lstrip()
    return text


def _is_picture(letter: str) -> bool:
    """Return whether a character is an emoji, its shade, or a joiner of emoji."""
    return unicodedata.category(letter) in ("So", "Sk", "Cf") or letter == "\ufe0f"


def _tells(letter: str) -> bool:
    """Return whether a character is a letter of any script, or an emoji."""
    return letter.isalpha() or unicodedata.category(letter) == "So"


def is_gerund(text: str) -> bool:
    """Return whether a text begins with an activity: *sailing*, *rock climbing*, but not *spring*."""
    return any(
        re.fullmatch(r"[a-z]*[aeiouy][a-z]*[b-df-hj-np-tv-z]?ing", word) and len(word) > 5
        for word in text.lower().split()[:2]
    ) and (likeness(text, "activity") > -0.2)


_DOUBLED = re.compile(r"(?:[^aeiou]|^)[aeiou][bdgmnpt]")


def gerund(text: str, seen: nlp.Analysis) -> str:
    """Return a verb phrase as a hobby: *reading books and swimming*."""
    verbs = {word.low for word in seen.tree.words if word.pos in ("VERB", "AUX")}

    def turned(found: re.Match[str]) -> str:
        verb = found[2].lower()
        if verb.endswith("ing") or (not found[1] and verb not in verbs):
            return found[2]
        if _DOUBLED.fullmatch(verb[-3:]) and len(verb) < 6:
            return verb + verb[-1] + "ing"
        return (verb[:-1] if verb.endswith("e") and not verb.endswith("ee") else verb) + "ing"

    text = re.sub(r"^(?:to )?go (?=[a-z]{2,}ing\b)", "", text)  # go swimming
    return re.sub(r"^(to )?(\w+)", turned, text)
