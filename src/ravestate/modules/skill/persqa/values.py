"""Values of topics: whether words can be one, and how it is written."""

from __future__ import annotations

import re
import unicodedata

from ravestate.modules import nlp

from .kinds import likeness
from .relations import relations
from .topics import Topic
from .wording import tidy

_CLOSED = frozenset(["PRON", "DET", "AUX", "SCONJ", "CCONJ", "PART", "ADV", "INTJ", "VERB", "ADP"])
_PLACES = frozenset(["GPE", "LOC", "FAC", "NORP"])
_TIMES = frozenset(["DATE", "TIME"])
LONGEST = {"name": 4, "people": 4, "place": 5}
DOUBT = {"place": -0.12, "work": -0.02, "organisation": 0.0, "subject": -0.35, "name": 0.12, "people": 0.12}
"""The least likeness of a value to its kind, where nothing introduces it."""
CERTAIN = {"place": -0.5, "work": -0.5, "organisation": -0.7, "subject": -0.7, "name": -0.6, "people": -0.6}
"""The least likeness where the words before it do."""
_LEADS = {
    **dict.fromkeys(("subject", "activity", "thing"), r"an? (?=\S)"),
    "work": r"(?:an?|the) (?=\S)",
    "place": r"(?:the )?(?:city|town|village) of (?=\S)",
}
"""Words before a value that are no part of it."""
_DEICTIC = re.compile(
    r"(?:this|that|these|those|it|you|him|her|them|me|us|my|your|here|there|more|most|a|many|much|"
    r"(?:any|some|every|no)(?:thing|one|body))\b",
    re.IGNORECASE,
)


def value_of(text: str, topic: Topic, seen: nlp.Analysis, *, sure: bool = True) -> str | None:
    """Return a value as it is kept; None if these words cannot be one.

    Args:
        text: The words.
        topic: The topic.
        seen: The analysis of the utterance.
        sure: Whether the words before it introduce this kind: *my name is*, or the agent asked for it.
    """
    kind = topic.kind
    text = re.sub(r"\.(?= )|,? (?:any ?(?:more|longer)|too|as well|now)$", "", _trimmed(text), flags=re.IGNORECASE)
    if lead := re.match(_LEADS.get(kind, "$^"), text, re.IGNORECASE):
        text = text[lead.end() :]
    words = text.lower().split()
    if not words or len(text) > 60 or len(words) > LONGEST.get(kind, 7):
        return None
    if kind == "number":
        return text if text.isdecimal() and 0 < int(text) < 120 else None
    named = kind in ("name", "people")
    table = relations().words
    never = table["function"] | table["determiners"] if named else table["function"]
    if never & set(words[named and words[0] == "will" :]) or not any(map(_tells, text)) or text[0].isdigit():
        return None
    if not _fits(text, words[0] in table["determiners"], topic, seen, sure):
        return None
    return tidy(gerund(text, seen) if kind == "activity" else text, topic)


def _fits(text: str, determined: bool, topic: Topic, seen: nlp.Analysis, sure: bool) -> bool:
    """Return whether words are of the kind of a topic; `determined` means that a determiner begins them."""
    kind = topic.kind
    if kind in ("activity", "thing"):
        return _DEICTIC.match(text) is None
    labels = {entity.label for entity in seen.entities if text.lower() in entity.text.lower()}
    digits = any(map(str.isdigit, text))
    if (labels & _TIMES and not labels & _PLACES) or (digits and kind != "organisation"):
        return kind in ("work", "subject")
    doubt = (CERTAIN if sure else DOUBT)[kind]
    match kind:
        case "name" | "people":
            if re.search(r"['’]s\b", text):
                return False
            parts = {word.pos for word in seen.tree.words if word.text in text.split()}
            if _is_name(text, seen, labels) or (not sure and parts & _CLOSED):
                return not parts & _CLOSED
        case "place" if labels & _PLACES:
            return True
        case "place" if determined:
            doubt = 0.0
        case "organisation" if "ORG" in labels:
            return True
        case "work" | "subject" if determined:
            return False
        case _:
            pass
    return likeness(text, "club" if topic.name == "club" else kind) > doubt


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
