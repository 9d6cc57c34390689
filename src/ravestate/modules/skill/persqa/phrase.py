"""Values in sentences: where a value ends, and whether words can be one."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Mapping

from ravestate.modules._text import printable

from .topics import Kind, Topic
from .wording import tidy
from .words import DETERMINERS, NEVER_IN, NO_EMPLOYER, NO_HOBBY, NO_PLACE, NO_SUBJECT, STATES

LONGEST = 500
"""Characters of an utterance that are read. A longer one answers no question."""

MARK = re.compile(r"[.;:!?…\n()\[\]{}<>|\"“”„«»]+|,(?=\S*\s*)|\s[-–—]+(?:\s|$)")
_TITLE = re.compile(r"\b(dr|mr|mrs|ms|prof|st)\.(?= ?\w)", re.IGNORECASE)
LISTED = re.compile(r"\s*(?:[,;/&+]|\band\b|\bor\b|\bas well as\b|\bplus\b)\s*", re.IGNORECASE)
HEDGES = re.compile(
    r"^(?:(?:also|sometimes|maybe|perhaps|mostly|mainly|just|only|actually|a bit of|a little|some|lots of|a lot of|"
    r"well|of course|basically|currently|now|originally|usually|really|still|like|to|called|named|both|and|or|e\.g\.) )+",
    re.IGNORECASE,
)
TAIL = re.compile(
    r"\s(?:too|as well|though|now|right now|at the moment|at present|these days|nowadays|currently|actually|originally|"
    r"mostly|mainly|sometimes|please|thanks|thank you|by the way|btw|here|there|again|anyway|of course|i guess|i think|"
    r"i suppose|you know|for now|any ?more|instead|then|lol|haha|and so on|and stuff|etc|by (?:trade|profession|training))$",
    re.IGNORECASE,
)
_ENDS: Mapping[Kind, str] = {
    "name": "and|but|or|from|by|because|so|since|what|how|nice|i|i'm|you|not|is|was|if|with|like|short|the|my|btw",
    "place": "and|but|or|since|because|so|for|with|where|which|who|that|when|while|though|although|if|as|by|i|i'm|"
    "my|we|you|it|not|is|was|has|have|until|before|after|together|in|near|at|right|these|on|last|recently|ago",
    "activity": "because|since|but|so|when|while|if|that|which|who|though|although|i'm|i am|my friends|in my|every|as a|"
    "more than|very much|a lot|quite often|most of all|as often|on (?:mon|tues|wednes|thurs|fri|satur|sun)days?|at (?:the )?weekends?|on weekends",
    "work": "and|but|or|at|for|from|in|with|because|since|so|when|while|if|that|which|who|though|although|i|i'm|my|on|not|by|near",
    "organisation": "because|since|but|so|when|while|if|that|which|who|though|although|as|in|on|with|for|near|"
    "and (?:i|i'm|my|live|work|have|am|also|it|love|like|we|come|study|play)|i|i'm|my|not|is",
    "subject": "at|in|because|since|but|so|when|while|if|that|which|who|though|although|with|for|i|i'm|my|on|not|"
    "and (?:i|i'm|my|live|work|have|am|also|it)",
    "people": "but|because|since|so|when|while|if|that|which|who|though|although|from|i|i'm|we|is|are|with|not",
    "thing": "because|since|but|so|when|while|if|that|which|who|though|although|as|more|very much|a lot|in my|every",
    "number": "years?|yrs?|and|but|now|this|next",
}
"""Words that follow a value of each kind without being part of it."""

ENDS = {kind: re.compile(rf"\s(?:{words})\b.*$", re.IGNORECASE | re.DOTALL) for kind, words in _ENDS.items()}


A_PLACE = re.compile(
    r"\b(?:town|city|village|suburb|capital|countryside|north|south|east|west|island|netherlands|hague|states|usa|us|uk|"
    r"kingdom|republic|region|area|coast|mountains|philippines|gambia|bahamas|congo|vatican)\b",
    re.IGNORECASE,
)


def plain(text: str) -> str:
    """Return the beginning of a text, with plain apostrophes and single spaces.

    Example:
        >>> plain("I’m\\t Ada")
        "I'm Ada"
    """
    text = unicodedata.normalize("NFC", printable(text[: 2 * LONGEST]))[:LONGEST]
    text = re.sub(r"[’‘ʼ´`]", "'", text)
    return re.sub(r"[^\S\n]+", " ", text).strip()


def values(rest: str, topic: Topic) -> tuple[str, ...]:
    """Return the values at the beginning of `rest`, tidied. `rest` follows words such as *I live in*.

    Example:
        >>> from .topics import TOPICS
        >>> values("new york since 2010", TOPICS["home"]), values("chess, and a bit of football!", TOPICS["hobby"])
        (('New York',), ('chess', 'football'))
    """
    pieces = _pieces(rest, topic)
    found: list[str] = []
    for piece in pieces:
        value = _value(piece, topic)
        if value is None:
            break  # nothing after such a piece is a value
        if value.casefold() not in [known.casefold() for known in found]:
            found.append(value)
    return tuple(found[: 5 if topic.many else 1])


def _pieces(rest: str, topic: Topic) -> Iterable[str]:
    if not topic.many and topic.kind != "people":
        rest = _TITLE.sub(r"\1", rest)
        # quotes end a value, but they may also surround it
        return [MARK.split(rest.lstrip(" .,;:-\"'“„«([{"), maxsplit=1)[0]]
    sentence = re.split(r"[.;:!?…\n()\"]", rest.lstrip(" .,;:-\"'"), maxsplit=1)[0]
    sentence = ENDS[topic.kind].sub("", " " + sentence)
    return [piece for piece in LISTED.split(sentence.strip()) if piece]


def _value(piece: str, topic: Topic) -> str | None:
    value = HEDGES.sub("", piece.strip())
    value = ENDS[topic.kind].sub("", " " + value).strip()
    while (shorter := TAIL.sub("", " " + value).strip()) != value:
        value = shorter
    value = _without_pictures(value).strip(" '-_*~.,")
    if topic.kind in ("work", "subject", "activity", "thing"):
        value = re.sub(r"^(?:a|an)\s+(?=\S)", "", value, flags=re.IGNORECASE)
    if topic.kind == "work":
        value = re.sub(r"^the\s+(?=\S)", "", value, flags=re.IGNORECASE)
    if not is_value(value, topic):
        return None
    return tidy(value, topic)


def is_value(value: str, topic: Topic) -> bool:
    """Return whether these words can be a value of `topic`."""
    words = value.lower().split()
    if not words or len(value) > 60 or len(words) > (4 if topic.kind in ("name", "people", "place") else 7):
        return False
    named = words[0] == "will" and topic.kind in ("name", "people")  # Will Smith
    if NEVER_IN & set(words[named:]) or not (topic.kind == "number" or any(map(_tells, value))):
        return False
    first = words[0]
    match topic.kind:
        case "name" | "people":
            return (
                first not in STATES
                and not any(letter.isdigit() for letter in words[0][:1])
                and "to" not in words
                and not re.match(r"[a-z]+ing\b", value)  # leaving, working
            )
        case "place":
            if any(letter.isdigit() for letter in value):
                return False
            if first in DETERMINERS:
                return A_PLACE.search(value) is not None
            return words[-1] not in NO_PLACE
        case "organisation":
            return (
                not NO_EMPLOYER & {first, words[-1]} and first not in ("and", "or", "not", "no") and not first.isdigit()
            )
        case "subject":
            return first not in NO_SUBJECT
        case "work":
            if first[0].isdigit() or re.match(r"[a-z]+ing\b", value):  # 25 years old, working on it
                return False
            return first not in STATES or value.lower() in ("retired", "self-employed", "freelance")
        case "activity" | "thing":
            return first not in NO_HOBBY
        case "number":
            return value.isdecimal() and 0 < int(value) < 120


def _without_pictures(value: str) -> str:
    """Return a value without the emoji around it; an emoji alone stays."""
    if not any(map(str.isalnum, value)):
        return value
    while _is_picture(value[-1]):
        value = value[:-1].rstrip()
    while _is_picture(value[0]):
        value = value[1:].lstrip()
    return value


def _is_picture(letter: str) -> bool:
    """Return whether a character is an emoji, its shade, or a joiner of emoji."""
    return unicodedata.category(letter) in ("So", "Sk", "Cf") or letter == "\ufe0f"


def _tells(letter: str) -> bool:
    """Return whether a character is a letter of any script, or an emoji."""
    return letter.isalpha() or unicodedata.category(letter) == "So"
