"""The user's name in an introduction: *it's me, Ilka*, *Ilka here*, *I'm Ilka*.

The words around the name decide, not the name itself, because the parser and the examples know few of the world's
names. A word that English does not have is a name; of a word that English has, the entity or the examples decide.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ravestate.language.lexicon import loaded_lexicon

from .answers import spelled_out
from .kinds import is_remark, likeness
from .topics import NAME, TOPICS
from .values import value_of
from .wording import among, same

if TYPE_CHECKING:
    from ravestate.modules import nlp

    from .reading import Reader

_CLAUSE = re.compile(r"[.!?;:,…–—()\n]+|\s(?:and|but|so)\s(?=(?:i|my|we|our|it|this)\b)", re.IGNORECASE)
_OPENERS = r"(?:(?:and|but|so|oh|ah|well|now|yes|yeah|no|nope|ok|okay|hi|hiya|hello|hey|hallo|again|actually|sorry|anyway|good \w+|by the way) )*"
_CLOSERS = r"(?: (?:again|here|speaking|by the way|actually|now|then|today|too|at your service|as it happens))*"
_NAME = r"(?P<name>[^\W\d][\w'’-]*(?: [^\W\d][\w'’-]*){0,2}?)"
_BESIDE = r"(?: from \w.*)?"
_FRAMES = [
    re.compile(frame, re.IGNORECASE)
    for frame in (
        rf"{_OPENERS}(?P<frame>(?:it is|its|this is)(?: me)?|i am) {_NAME}{_CLOSERS}{_BESIDE}",
        rf"{_OPENERS}{_NAME} (?:again )?(?P<frame>here)(?: again)?{_BESIDE}",
    )
]
_ME = re.compile(rf"{_OPENERS}(?:it is|its|this is)(?: only| just)? me{_CLOSERS}", re.IGNORECASE)
_POINTING = re.compile(r"it|this", re.IGNORECASE)


def introduced_in(reader: Reader) -> str:
    """Return the name in an introduction; empty if the user does not introduce themselves."""
    text = spelled_out(reader.tree.text)
    pieces = [(piece.strip(), after) for piece, after in _pieces(text)]
    before, said = "", False
    verbs = {word.low for word in reader.tree.words if word.pos in ("VERB", "AUX")}
    for piece, mark in pieces:
        if "?" in mark and not before:
            continue
        found = next(filter(None, (frame.fullmatch(piece) for frame in _FRAMES)), None)
        pointed = found and _POINTING.match(found["frame"])
        # As in "my dog isn't Rex, it's Max".
        another = found is not None and pointed and (said or _means_another(reader, found["name"]))
        if found and not another and (name := given_name(found["name"], reader.seen)):
            return name
        if _ME.fullmatch(before) and (name := given_name(piece, reader.seen)):
            return name
        before = piece
        said = said or bool(verbs & set(re.findall(r"\w+", piece.lower())))
    return ""


def given_name(words: str, seen: nlp.Analysis) -> str:
    """Return words as the name of a person; empty if they are none: *Ilka*, but not *tired*."""
    first, *others = words.split() or [""]
    if not first or any(word.islower() and not _is_foreign(word) for word in others):
        return ""  # "Hamburg calling"
    tags = {word.pos for word in seen.tree.words if word.text in words.split()}
    persons = {entity.label for entity in seen.entities if first in entity.text} <= {"PERSON", "ORG"}
    sure = _is_foreign(first) and not is_remark(words)
    if "NUM" in tags or not (sure or (persons and likeness(words, NAME) > 0)):
        return ""
    return value_of(words, TOPICS[NAME], seen, sure=sure) or ""


def _pieces(text: str) -> list[tuple[str, str]]:
    """Return the clauses of a text, each with the mark after it."""
    ends = [*_CLAUSE.finditer(text)]
    starts = [0, *(end.end() for end in ends)]
    marks = [*(end[0] for end in ends), ""]
    stops = [*(end.start() for end in ends), len(text)]
    return [(text[start:stop], mark) for start, stop, mark in zip(starts, stops, marks, strict=True)]


def _is_foreign(word: str) -> bool:
    """Return whether English has no such word, nor a frequent one for which it may be a typing error."""
    lexicon, low = loaded_lexicon(), word.lower()
    if lexicon is None or len(word) < 3 or not lexicon.rare(low):
        return False
    return word[:1].isupper() or lexicon.correction(low) == low


def _means_another(reader: Reader, name: str) -> bool:
    """Return whether *it is Ilka* answers a question about another, corrects another value, or names a place."""
    topic = reader.asked or reader.recent
    if topic != NAME and any(same(one.right.text, name) for one in reader.seen.contrasts):
        return not any(among(one.wrong.text, reader.known.get(NAME, ())) for one in reader.seen.contrasts)
    return topic not in ("", NAME) and (bool(reader.asked) or TOPICS[topic].kind in ("people", "place", "organisation"))
