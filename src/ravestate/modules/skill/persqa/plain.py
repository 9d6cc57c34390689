"""The plainest sentences in which users tell facts.

They replace the tagger (a network that finds facts) until it is loaded, or if it is missing.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravestate.language.tagger import Tag
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.introduction import introductions_in

from .topics import NAME, TOPICS

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
_THINGS = frozenset(("NORP", "GPE", "LOC", "LANGUAGE", "DATE", "TIME"))
"""The parser's labels of words with capitals that are no user's name: *German*, *Monday*."""
LONGEST = 3
"""The maximum number of words of a bare answer."""


def plain_tags(text: str, asked: str, seen: nlp.Analysis | None = None) -> tuple[Tag, ...]:
    """Return the values in the plainest sentences.

    If there are none, up to `LONGEST` words may be a bare answer to a question about the topic `asked`. With `seen`, the
    analysis of the text, an introduction also gives the user's name: *I'm Nora*.
    """
    found = tuple(_found(text))
    introduced = () if seen is None else tuple(introductions_in(seen.tree))
    if seen is not None and not any(tag.label == NAME for tag in found):
        found = (*_introduced(seen, asked), *found)
    bare = "" if introduced and asked == NAME else text.strip(" .!")  # "I'm tired" is no name
    if not found and asked in TOPICS and bare and "?" not in bare and len(bare.split()) <= LONGEST:
        start = text.index(bare)
        return (Tag(asked, bare, start, start + len(bare), negated=False, score=1.0),)
    return found


def _introduced(seen: nlp.Analysis, asked: str) -> Iterator[Tag]:
    """Yield the name with which the user introduces themselves.

    The parser must take it for a person's name. A capital is enough if the words can only introduce a name, or if the
    agent has asked for it. Peoples, places and dates have capitals, too, and do not count.
    """
    persons = {entity.text.lower() for entity in seen.entities if entity.label == "PERSON"}
    things = {entity.text for entity in seen.entities if entity.label in _THINGS}
    for one in introductions_in(seen.tree):
        capital = (
            all(word[0].isupper() for word in one.name.split())
            and one.name not in things
            and (one.sure or asked == NAME)
        )
        others = one.pointing and not one.present and asked != NAME  # "my dog isn't Rex, it's Max"
        if (capital or one.name.lower() in persons) and not others:
            start = seen.tree.text.index(one.name)
            yield Tag(NAME, one.name, start, start + len(one.name), negated=False, score=1.0)
            return


def _found(text: str) -> Iterator[Tag]:
    for topic, sentence in _SENTENCES.items():
        for found in re.finditer(sentence, text):
            noun = (found.groupdict().get("noun") or "").lower()
            label = next((one.name for one in TOPICS.values() if noun and noun in one.nouns), topic)
            yield Tag(label, found["value"], *found.span("value"), negated=False, score=1.0)
