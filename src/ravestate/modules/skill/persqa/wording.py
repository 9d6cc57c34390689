"""The spelling of facts about users (*Ulm* for the topic `home`), their wording in sentences, and replies as intents.

An *intent* names what the agent wants to say; the module `verbaliser` puts it into words.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Mapping, Sequence

from ravestate.modules.meta.verbaliser.intents import Intent

from .topics import TOPICS, WORDS, Topic, in_order

PACKAGE = __name__.rpartition(".")[0]
"""The package with the phrases."""

Facts = Mapping[str, tuple[str, ...]]
"""Values by topic; an empty tuple means that there are none."""


def tidy(text: str, topic: Topic) -> str:
    """Return a value in its usual spelling: names with capitals, work in lower case, the rest as the user wrote it.

    Example:
        >>> tidy("new york", TOPICS["home"]), tidy("Nurse", TOPICS["occupation"]), tidy("ibm", TOPICS["employer"])
        ('New York', 'nurse', 'IBM')
    """
    if topic.kind == "work":
        return " ".join(word.lower() if word[1:].islower() else word for word in text.split())
    group = topic.kind == "organisation"
    shouted = text.isupper() and not group and len(text) > (3 if topic.kind == "place" else 2)  # "USA" and "JP" stay
    begins = re.match(r"(?:an?|the|my|our)\b" if group else r"an? \w", text, re.IGNORECASE)
    named = group or topic.kind in ("name", "people", "place")
    if begins or not named or (text != text.lower() and not shouted):
        return text
    return text.upper() if group and len(text) <= 3 else _capitals(text.lower())


def _capitals(text: str) -> str:
    """Return names with capitals. `str.title` would write *O'Brien'S*, and *Frankfurt Am Main*."""

    def cased(found: re.Match[str]) -> str:
        word = found[0]
        inner = word in WORDS["small"] and (found.start() or word == "the")
        return word if inner else word[:1].upper() + word[1:]

    return re.sub(r"\bO'\w", lambda found: found[0].upper(), re.sub(r"[^\s-]+", cased, text))


def _key(value: str) -> str:
    return re.sub(r"^(?:the|an?) (?=.)", "", " ".join(value.casefold().split()))


def same(one: str, other: str) -> bool:
    """Return whether two values are equal, apart from capitals, spaces and an article at the beginning.

    Example:
        >>> same("The Red Cross", "red cross")
        True
    """
    return _key(one) == _key(other)


def among(value: str, others: Iterable[str]) -> bool:
    """Return whether `value` is the `same` as one of `others`."""
    return any(same(value, other) for other in others)


def without(values: Iterable[str], others: Iterable[str]) -> tuple[str, ...]:
    """Return the values that are not among `others`."""
    others = tuple(others)
    return tuple(value for value in values if not among(value, others))


def alike(value: str, others: Iterable[str]) -> bool:
    """Return whether one of `others` has all words of `value`, or only words of it: *Bremen*, *the city of Bremen*."""
    words = set(_key(value).split())
    return any(words and (words <= set(_key(other).split()) or words >= set(_key(other).split())) for other in others)


def mentioned(text: str, known: Facts) -> str:
    """Return the topic of the user's fact that the agent's words mention; empty if they mention none, or several.

    Only sentences with *you*, *your* or *yours* count.

    Example:
        >>> mentioned("How do you like Ulm?", {"home": ("Ulm",), "age": ("36",)})
        'home'
    """
    found = {
        topic
        for sentence in re.split(r"[.!?]\s+", text)
        if re.search(r"\byour?s?\b", sentence, re.IGNORECASE)
        for topic, values in known.items()
        if any(re.search(rf"\b{re.escape(value)}\b", sentence) for value in values)
    }
    return found.pop() if len(found) == 1 else ""


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
    return joined([_with_article(value) if TOPICS[topic].kind == "work" else value for value in values])


def _with_article(noun: str) -> str:
    if noun in WORDS["bare"]:
        return noun
    return f"{'an' if re.match(r'(?!uni(?!n)|use|euro)[aeiou]', noun, re.IGNORECASE) else 'a'} {noun}"


def clause(topic: str, values: Sequence[str]) -> str:
    """Return a fact as a clause that the user hears.

    Example:
        >>> clause("home", ["Hannover"])
        'you live in Hannover'
    """
    about = TOPICS[topic]
    if about.kind == "people" and about.role and len(values) > 1:
        return f"your {'children' if topic == 'child' else f'{topic}s'} are {joined(values)}"
    return about.clause.format(spoken(topic, values))


def clauses(known: Facts) -> str:
    """Return all that is known, one clause per topic."""
    return joined([clause(topic, known[topic]) for topic in in_order(known) if known[topic]])


# ------------------------------------------------------------------------------------ replies


def say(intent: str, known: Facts, **parameters: str | None) -> Intent:
    """Return an intent whose phrases may use all known facts, and `parameters`."""
    mentioned = {topic: spoken(topic, values) for topic, values in known.items() if values}
    return Intent(intent, {**mentioned, **parameters}, PACKAGE)


def asking(topic: str, known: Facts) -> Intent:
    """Return the question about a topic."""
    return say(f"ask_{topic}", known)


def learned(topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Return a reply that shows which `values` were understood."""
    if not TOPICS[topic].asked:
        return say("learned", known, value=spoken(topic, values))
    return say(f"learned_{topic}", known, **{topic: spoken(topic, values)})


def stating(intent: str, topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Return a reply that states the values of a topic. In its phrases, ``{fact}`` is a clause with these values."""
    return say(intent, known, fact=clause(topic, values))


def memorable(remembered: Facts, chance: random.Random) -> str:
    """Return a random topic among those with remembered values."""
    return chance.choice([topic for topic, values in remembered.items() if values])
