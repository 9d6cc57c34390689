"""The answer about a topic: its phrases, with the known facts filled in."""

from __future__ import annotations

import re
import string
from collections.abc import Mapping, Sequence
from datetime import date, datetime

from .itself import texts
from .life import Fact, Topic


def telling(
    topic: Topic, question: str, facts: Mapping[str, Fact], *, mood: str, now: datetime
) -> tuple[str, ...] | None:
    """Return the phrases to choose from; None if no phrase fits the question, or if every phrase needs an unknown fact.

    Args:
        topic: The topic.
        question: The question in lower case, without punctuation and short forms. If it names a value of a fact, the
            answer is about this value. If all phrases about the value need unknown facts, the topic's phrases answer.
        facts: The agent's facts.
        mood: The agent's mood.
        now: The current time, for the agent's age, the date and the time of day.
    """
    values = _in_words(facts, mood, now)
    names_a_value = False
    for fact, phrases in topic.named:
        for it, that in _pairs(facts.get(fact, ())):
            if _names(question, it):
                if filled := _filled(phrases, {**values, "it": it, "that": that}):
                    return filled
                names_a_value = True
    if names_a_value:  # `unnamed` and `otherwise` would deny the value
        return _filled(topic.phrases, values) or None
    if _PARTICULAR.match(question) and (topic.unnamed or topic.named):
        return _filled(topic.unnamed, values) or None
    if topic.named and not topic.unnamed and _FAVOURITE.search(question):
        return None
    return _filled(topic.phrases, values) or _filled(topic.otherwise, values) or None


def listed(items: Sequence[str]) -> str:
    """Join texts into an enumeration.

    Example:
        >>> listed(["words", "clouds", "chess"])
        'words, clouds and chess'
    """
    *first, last = items
    return f"{', '.join(first)} and {last}" if first else last


def age(born: date, today: date) -> str:
    """Return an age in years. An age below one year is in months, and an age below two months in days.

    Example:
        >>> age(date(2024, 3, 1), date(2026, 2, 28)), age(date(2024, 3, 1), date(2024, 5, 1))
        ('1 year', '2 months')
    """
    months = (today.year - born.year) * 12 + today.month - born.month - (today.day < born.day)
    if months < 2:
        count, unit = max(0, (today - born).days), "day"
    elif months < 12:
        count, unit = months, "month"
    else:
        count, unit = months // 12, "year"
    return f"{count} {unit}{'' if count == 1 else 's'}"


def without_question(phrase: str) -> str:
    """Return a phrase without the question at its end, unless the phrase is nothing but a question.

    Example:
        >>> without_question("I am fine, thank you. And you?"), without_question("Who knows?")
        ('I am fine, thank you.', 'Who knows?')
    """
    return _QUESTION_AT_THE_END.sub("", phrase)


def _in_words(facts: Mapping[str, Fact], mood: str, now: datetime) -> dict[str, str]:
    values = {name: listed(texts(fact)) for name, fact in facts.items() if fact}
    values |= {"mood": mood, "time": f"{now:%H:%M}", "date": f"{now:%A}, {now.day} {now:%B} {now.year}"}
    if "born" in values:
        born = date.fromisoformat(values["born"])
        values["born"] = f"{born.day} {born:%B} {born.year}"
        values["age"] = age(born, now.date())
    return values


def _pairs(fact: Fact) -> list[tuple[str, str]]:
    if isinstance(fact, str):
        return [(fact, fact)]
    return [(part, part) if isinstance(part, str) else part for part in fact]


def _names(question: str, it: str) -> bool:
    """Return whether a question names a thing; *can you sing* names *singing*, *do you like rain* names *rainy days*."""
    if re.search(rf"\b{re.escape(it.lower().removesuffix('ing'))}(?:ing)?\b", question):
        return True
    liked = _LIKED.search(question)
    words = _stems(liked[1]) - _FILLING if liked else set[str]()
    return bool(words) and words <= _stems(it.lower())


def _stems(text: str) -> set[str]:
    return {re.sub(r"y$|ing$", "", word.removesuffix("s")) for word in re.findall(r"[a-z-]+", text)}


def _filled(phrases: Sequence[str], values: Mapping[str, str]) -> tuple[str, ...]:
    """Return the phrases whose parameters are all known, with these parameters filled in."""
    known = [phrase for phrase in phrases if _parameters(phrase) <= values.keys()]
    return tuple(_BEGINNING.sub(lambda found: found[0].upper(), phrase.format_map(values)) for phrase in known)


def _parameters(phrase: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(phrase) if name}


_PARTICULAR = re.compile(
    r"(?:(?:and|so|but|well|oh|then) )*(?:can|could|do|are) you (?!(?:[\w-]+ )*(?:have|any|anything|anybody|some|something|everything|what|which|or)\b)"
)
"""First words of a yes/no question about one thing."""
_FAVOURITE = re.compile(
    r"\bfavou?rite (?!things?\b|of\b)\w+|\b(?:what|which)(?: (?:kind|sort)s? of)? \w+ do you (?:like|love|prefer|hate)\b"
)
"""A question about the agent's favourite of one kind: *what is your favourite bird*, *which bird do you like best*."""
_LIKED = re.compile(r"\b(?:like|love|enjoy|hate|fond of|into|mind) (.+)$")
"""A question such as *do you like rain*. The pattern's group is the thing: *rain*."""
_FILLING = frozenset(
    ("it", "when", "the", "a", "an", "to", "it'", "really", "very", "much", "too", "also", "weather", "outside")
)
_QUESTION_AT_THE_END = re.compile(r"(?<=[.!…])\s+[^.!?…]+\?$")
_BEGINNING = re.compile(r"^\W*\w|[.!?…:] +\w")
"""The first letter of a sentence. It may be part of a fact."""
