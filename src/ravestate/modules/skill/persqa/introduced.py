"""The user's name in an introduction: *it's me, Ilka*, *Ilka here*, *I'm Ilka*.

`nlp` finds the words in the place of a name. A word that English does not have is a name. For a word that English has,
the named entities or the examples decide. The parser and the examples know few of the world's names.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ravestate.language.lexicon import loaded_lexicon
from ravestate.modules.meta.nlp.introduction import introductions_in

from .kinds import is_remark, likeness
from .topics import NAME, TOPICS
from .utterance import Utterance
from .values import value_of
from .wording import among, same

if TYPE_CHECKING:
    from ravestate.modules import nlp


def introduced_in(reader: Utterance) -> str:
    """Return the name in an introduction; empty if the user does not introduce themselves."""
    for one in introductions_in(reader.tree):
        another = one.pointing and (one.late or _means_another(reader, one.name))
        if not another and (name := given_name(one.name, reader.seen)):
            return name
    return ""


def given_name(words: str, seen: nlp.Analysis) -> str:
    """Return words as the name of a person; empty if they are no name: *Ilka*, but not *tired*."""
    first, *others = words.split() or [""]
    if not first or any(word.islower() and not _is_foreign(word) for word in others):
        return ""  # "Hamburg calling"
    tags = {word.pos for word in seen.tree.words if word.text in words.split()}
    persons = {entity.label for entity in seen.entities if first in entity.text} <= {"PERSON", "ORG"}
    sure = _is_foreign(first) and not is_remark(words)
    if "NUM" in tags or not (sure or (persons and likeness(words, NAME) > 0)):
        return ""
    return value_of(words, TOPICS[NAME], seen, sure=sure) or ""


def _is_foreign(word: str) -> bool:
    """Return whether a word is neither English, nor a likely typing error for a frequent English word."""
    lexicon, low = loaded_lexicon(), word.lower()
    if lexicon is None or len(word) < 3 or not lexicon.rare(low):
        return False
    return word[:1].isupper() or lexicon.correction(low) == low


def _means_another(reader: Utterance, name: str) -> bool:
    """Return whether *it is Ilka* answers a question about somebody else, corrects another value, or names a place."""
    topic = reader.asked or reader.recent
    if topic != NAME and any(same(one.right.text, name) for one in reader.seen.contrasts):
        return not any(among(one.wrong.text, reader.known.get(NAME, ())) for one in reader.seen.contrasts)
    return topic not in ("", NAME) and (bool(reader.asked) or TOPICS[topic].kind in ("people", "place", "organisation"))
