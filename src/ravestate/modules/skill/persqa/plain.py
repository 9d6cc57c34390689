"""The plainest sentences in which users tell facts.

They replace the tagger (a network that finds facts) until it is loaded, or if it is missing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravestate.language.tagger import Tag

from .topics import TOPICS

_BEGIN = r"(?:^\W*|[.!?,;] |\band )(?i:"
_END = r"(?=\s*(?:[,.!?;]|$|\band\b|\bbut\b))"
_NAME = r"(?P<value>[^\W\d_a-z][^\s.,;!?\")]*(?: [A-Z][\w'-]+){0,3})"
"""A name begins with a capital: the normal form gives names their capitals."""
_ANY_NAME = r"(?!not\b)(?P<value>[^\s\d_.,;!?'\")][^\s.,;!?\")]*(?: [A-Z][\w'-]+){0,3})"
"""A name of any characters: 🦊."""
_WORDS = r"(?:an? |the )?(?P<value>[\w'-]+(?: [\w'-]+){0,2})"
_PEOPLE = "|".join(noun for topic in TOPICS.values() if topic.kind == "people" for noun in topic.nouns)
_SENTENCES = {
    "name": rf"{_BEGIN}my name(?: is|['’]s) ){_ANY_NAME}",
    "home": rf"{_BEGIN}(?:i|we) live in ){_NAME}{_END}",
    "origin": rf"{_BEGIN}(?:i come|i am|we come) from ){_NAME}{_END}",
    "age": rf"{_BEGIN}i am )(?P<value>\d+)(?: years old)?{_END}",
    "occupation": rf"{_BEGIN}i work as ){_WORDS}{_END}",
    "people": rf"{_BEGIN}my (?P<noun>{_PEOPLE})(?:['’]s name is| is called) ){_NAME}{_END}",
}
LONGEST = 3
"""The maximum number of words of a bare answer."""


def plain_tags(text: str, asked: str) -> tuple[Tag, ...]:
    """Return the values in the plainest sentences.

    If there are none, up to `LONGEST` words may be a bare answer to a question about the topic `asked`.
    """
    found = tuple(_found(text))
    bare = text.strip(" .!")
    if not found and asked in TOPICS and bare and "?" not in bare and len(bare.split()) <= LONGEST:
        start = text.index(bare)
        return (Tag(asked, bare, start, start + len(bare), negated=False, score=1.0),)
    return found


def _found(text: str) -> Iterator[Tag]:
    for topic, sentence in _SENTENCES.items():
        for found in re.finditer(sentence, text):
            noun = (found.groupdict().get("noun") or "").lower()
            label = next((one.name for one in TOPICS.values() if noun and noun in one.nouns), topic)
            yield Tag(label, found["value"], *found.span("value"), negated=False, score=1.0)
