"""The values of topics: the words that can be a value, and memory's spelling of a value."""

from __future__ import annotations

import contextlib
import re
import unicodedata

from ravestate.modules import nlp

from .kinds import FITTING, likeness
from .topics import WORDS, Topic
from .wording import tidy

_CLOSED = frozenset(["PRON", "DET", "AUX", "SCONJ", "CCONJ", "PART", "ADV", "INTJ", "VERB", "ADP"])
_PLACES = frozenset(["GPE", "LOC", "FAC", "NORP"])
_TIMES = frozenset(["DATE", "TIME"])
LONGEST = {"name": 4, "people": 4, "place": 5}
"""Kind → the maximum number of words of a value; 7 for other kinds."""
_LEADS = {
    **dict.fromkeys(("subject", "activity", "thing"), r"an? (?=\S)"),
    "work": r"(?:an?|the) (?=\S)",
    "place": r"(?:the )?(?:city|town|village) of (?=\S)|.*\b(?:called|named) (?=\S)",
}
"""Words that stand before a value and do not belong to the value."""
_ANYTHING = re.compile(r"(?:any|some|every|no)(?:thing|one|body|where)\b", re.IGNORECASE)
_DEICTIC = re.compile(
    r"(?:this|that|these|those|it|you|him|her|them|me|us|my|your|here|there|more|most|a|many|much|"
    r"(?:any|some|every|no)(?:thing|one|body))\b",
    re.IGNORECASE,
)


def value_of(text: str, topic: Topic, seen: nlp.Analysis, *, sure: bool = True) -> str | None:
    """Return some words as a value in memory's spelling; None if they cannot be a value of the topic.

    Args:
        text: The words.
        topic: The topic.
        seen: The analysis of the utterance.
        sure: Whether the value is expected: the agent asked for it, or words such as *my name is* precede it.
    """
    kind = topic.kind
    text = re.sub(
        r"\.(?= )|,? (?:any ?(?:more|longer)|too|as well|now|by the way)$", "", _trimmed(text), flags=re.IGNORECASE
    )
    text = (
        re.sub(r"^(?:my )?name (?=\w)", "", text, flags=re.IGNORECASE) if kind == "name" else text
    )  # "my name Mehmet"
    text = re.sub(f"^(?:{_LEADS.get(kind, '')})", "", text, flags=re.IGNORECASE)
    words = text.lower().split()
    if not words or len(text) > 60 or len(words) > LONGEST.get(kind, 7):
        return None
    if kind in ("work", "subject") and any(word.low == words[0] and word.pos == "ADP" for word in seen.tree.words):
        return None  # "between jobs"
    if kind in ("name", "people") and any(w.text == words[0] and w.pos in ("ADP", "SCONJ") for w in seen.tree.words):
        return None  # "it's about volcanoes"
    if kind != "name" and (_DEICTIC if kind in ("activity", "thing") else _ANYTHING).match(text):
        return None
    if text.lower() in topic.nouns:  # "I go to university"
        return None
    if kind == "number":
        number = number_in(text)
        return number if 0 < int(number or 0) < 120 else None
    named = kind in ("name", "people")
    never = (WORDS["function"] | WORDS["sayings"] if named else WORDS["function"]) | (
        WORDS["determiners"] if named else frozenset[str]()
    )
    tells = any(unicodedata.category(letter)[0] in "L" or unicodedata.category(letter) == "So" for letter in text)
    if never & set(words[named and words[0] == "will" :]) or not tells or text[0].isdigit():
        return None
    if not _fits(text, words[0] in WORDS["determiners"], topic, seen, sure):
        return None
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
        return text
    import text_to_num  # pyright: ignore[reportMissingTypeStubs]

    with contextlib.suppress(ValueError):
        return str(text_to_num.text2num(text.lower(), "en"))  # pyright: ignore[reportUnknownArgumentType, reportUnknownMemberType]
    return ""


def _fits(text: str, determined: bool, topic: Topic, seen: nlp.Analysis, sure: bool) -> bool:
    """Return whether words suit the kind of a topic; `determined` says whether they begin with a determiner."""
    kind = topic.kind
    if kind in ("activity", "thing"):
        return True
    labels = {entity.label for entity in seen.entities if text.lower() in entity.text.lower()}
    if kind == "place":  # "Sendai in Japan"
        labels |= {entity.label for entity in seen.entities if f"{text} in {entity.text}" in seen.tree.text}
    digits = any(map(str.isdigit, text))
    if (labels & _TIMES and not labels & _PLACES) or (digits and kind != "organisation"):
        return kind in ("work", "subject")
    least = -0.6 if sure else 0.0
    match kind:
        case "name" | "people":
            if re.search(r"['’]s\b", text):
                return False
            parts = {word.pos for word in seen.tree.words if word.text in text.split()}
            if text.islower() and seen.normal.original[:1].isupper() and parts & {"ADJ", "NUM"}:
                return False  # "The name is ordinary", "She is three": this user writes names with a capital
            capital = text[:1].isupper() and not text.isupper() and not labels
            if not parts & {*_CLOSED, "ADJ"} and ("PERSON" in labels or capital):
                return True
            if not sure and parts & _CLOSED:
                return False
        case "place" if labels & _PLACES:
            return True
        case "place" if _is_proper(text, seen):
            least = -0.6
        case "place" if determined:
            least = 0.0
        case "organisation" if number_in(text):
            return False  # "at work at six"
        case "organisation" if "ORG" in labels:
            return True
        case "organisation" if sure and any(
            entity.label in _PLACES and entity.text.lower() in text.lower() for entity in seen.entities
        ):  # "study at Uppsala", "the city of Utrecht"
            return True
        case "organisation" if _is_proper(text, seen) and "PERSON" not in labels:
            least = -0.6
        case "work" | "subject" if determined:
            return False
        case _:
            pass
    return likeness(text, topic.name if topic.name in FITTING else kind) > least


def _is_proper(text: str, seen: nlp.Analysis) -> bool:
    """Return whether the parser takes words for a name."""
    found = {word.text: word.pos for word in seen.tree.words}
    return (text[:1].isupper() or text.capitalize() in seen.normal.text) and all(
        found.get(word, "PROPN") == "PROPN" for word in text.split()
    )


def _trimmed(text: str) -> str:
    """Return a text without the punctuation and the emoji around it. A text of emoji alone stays."""
    kept = [at for at, letter in enumerate(text) if unicodedata.category(letter)[0] in "LN" or letter in "+#"]
    return text[kept[0] : kept[-1] + 1] if kept else text.strip(" \"'.,;:!?-_*~()[]{}<>|“”„«»…`\n")


def is_gerund(text: str) -> bool:
    """Return whether a text begins with an activity in *-ing*: *sailing*, *rock climbing*, but not *spring*."""
    return bool(re.match(r"(?:\w+ )?\w{3,}ing\b", text)) and likeness(text, "activity") > -0.2


def gerund(text: str, seen: nlp.Analysis) -> str:
    """Return a verb phrase in the form of a hobby: *reading books* for *read books*."""
    verbs = {word.low for word in seen.tree.words if word.pos in ("VERB", "AUX")}

    def turned(found: re.Match[str]) -> str:
        verb = found[2].lower()
        if verb.endswith("ing") or (not found[1] and verb not in verbs):
            return found[2]
        if len(verb) < 6 and re.search(r"(?:[^aeiou]|^)[aeiou][bdgmnpt]$", verb):
            return f"{verb}{verb[-1]}ing"
        return re.sub(r"(?<!e)e$", "", verb) + "ing"

    text = re.sub(r"^(?:to )?go (?=[a-z]{2,}ing\b)", "", text)  # "go swimming"
    return re.sub(r"^(to )?(\w+)", turned, text)
