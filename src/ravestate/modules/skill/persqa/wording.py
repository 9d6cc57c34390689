"""The spelling of values, and their wording in sentences."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from .relations import relations
from .topics import TOPICS, Topic

BARE = frozenset(["retired", "self-employed", "freelance", "unemployed"])
"""Occupations without an article."""


def tidy(text: str, topic: Topic) -> str:
    """Return a value in its usual spelling: names with capitals, the rest in the user's words.

    Example:
        >>> tidy("new york", TOPICS["home"]), tidy("Nurse", TOPICS["occupation"]), tidy("ibm", TOPICS["employer"])
        ('New York', 'nurse', 'IBM')
    """
    words = text.split()
    match topic.kind:
        case "name" | "people" | "place":
            shouted = text.isupper() and len(text) > (3 if topic.kind == "place" else 2)  # but USA, and JP
            if text != text.lower() and not shouted:
                return text
            if words[0].lower() in ("a", "an") and len(words) > 1:
                return text  # a small town
            return " ".join(
                _capital(word.lower(), first=not index and word != "the") for index, word in enumerate(words)
            )
        case "organisation":
            if text != text.lower() or words[0] in ("a", "an", "the", "my", "our"):
                return text
            if len(text) <= 3:
                return text.upper()
            return " ".join(_capital(word, first=not index) for index, word in enumerate(words))
        case "work":
            return " ".join(word.lower() if word[1:].islower() else word for word in words)
        case _:
            return text


def _capital(word: str, *, first: bool) -> str:
    if word in relations().words["small"] and not first:
        return word
    # str.title would write "O'Brien'S", and str.capitalize "Mckay"
    parts = word.split("-")
    word = "-".join(
        part if index and part in relations().words["small"] else part[:1].upper() + part[1:]
        for index, part in enumerate(parts)
    )
    return "O'" + word[2:3].upper() + word[3:] if word.startswith("O'") else word


def same(one: str, other: str) -> bool:
    """Return whether two values mean the same.

    Example:
        >>> same("The Red Cross", "red cross")
        True
    """
    return _key(one) == _key(other)


def among(value: str, others: Iterable[str]) -> bool:
    """Return whether one of `others` means the same as `value`."""
    return any(same(value, other) for other in others)


def alike(value: str, others: Iterable[str]) -> bool:
    """Return whether one of `others` means the same, or names a part of it: *Bremen* of *the city of Bremen*."""
    words = set(_key(value).split())
    return any(words and (words <= set(_key(other).split()) or words >= set(_key(other).split())) for other in others)


def _key(value: str) -> str:
    words = value.casefold().split()
    return " ".join(words[1:] if len(words) > 1 and words[0] in ("the", "a", "an") else words)


def joined(values: Sequence[str]) -> str:
    """Return the values as an enumeration.

    Example:
        >>> joined(["chess", "football", "tea"])
        'chess, football and tea'
    """
    return values[0] if len(values) == 1 else f"{', '.join(values[:-1])} and {values[-1]}"


def spoken(topic: str, values: Sequence[str]) -> str:
    """Return values as they appear in a sentence.

    Example:
        >>> spoken("occupation", ["engineer"])
        'an engineer'
    """
    if TOPICS[topic].kind != "work":
        return joined(values)
    return joined([value if value in BARE else f"{_article(value)} {value}" for value in values])


def _article(noun: str) -> str:
    low = noun.lower()
    like_you = low.startswith(("uni", "use", "euro")) and not low.startswith("unin")
    return "an" if low[:1] in "aeiou" and not like_you else "a"


def clause(topic: str, values: Sequence[str]) -> str:
    """Return a fact as a clause that the user hears.

    Example:
        >>> clause("home", ["Hannover"])
        'you live in Hannover'
    """
    about = TOPICS[topic]
    if about.kind == "people" and about.role and len(values) > 1:
        plural = "children" if topic == "child" else f"{topic}s"
        return f"your {plural} are {joined(values)}"
    return about.clause.format(spoken(topic, values))
