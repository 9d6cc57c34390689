"""Fragments about the user, as statements: *from Cork*, *now in Derby*, *44*."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase, phrase_of
from ravestate.modules.meta.nlp.tree import SUBJECTS, Word

from .introduced import introduced_in
from .utterance import Utterance

_ENDS = frozenset([".", "!", "?", ";", "..."])
_JOINTS = frozenset([",", "and", "but", "&", "-", "–", ":"])
_NOW = frozenset(["now", "currently", "presently", "nowadays", "been", "based"])
_LEADS = _NOW | {"originally", "initially", "just", "also", "still", "actually", "here"}
_OWN = frozenset(["i", "we", "that", "it", "me"])
_I = Phrase("I", person="I")


def fragments_in(reader: Utterance) -> Iterator[nlp.Statement]:
    """Yield a statement for each part of a sentence that has neither a subject nor a finite verb."""
    for sentence in _split(reader.tree.words, _ENDS):
        subjects = {word.low for word in sentence if word.dep in SUBJECTS}
        finite = any(
            word.tag in ("VBD", "VBP", "VBZ", "MD") and word.lemma not in ("be", "'s", "'m") for word in sentence
        )
        pieces = list(_split(sentence, _JOINTS))
        for piece in pieces if subjects <= _OWN and len(pieces) > 1 else ():
            low = [word.low for word in piece]
            rest = list(itertools.dropwhile(lambda word: word.low in _LEADS, piece))
            if rest and (rest[0].low == "from" or rest[0].pos == "NOUN"):
                first = rest[0].low == "from" and (piece == pieces[0] or rest != piece or subjects)
                origin = [word for word in rest if word.low == "from"][:1] if first or introduced_in(reader) else []
                yield from (_being(reader, word) for word in origin if not finite)
            if rest and rest[0].low in ("in", "near") and _NOW & set(low):
                yield from (_being(reader, word, " now") for word in rest[:1])
            years = low[1:3] == ["years", "old"] and bool(subjects)
            if piece[0].pos == "NUM" and (years or (len(piece) == 1 and not subjects and introduced_in(reader))):
                yield _statement(Phrase(piece[0].text))


def _split(words: Sequence[Word], at: frozenset[str]) -> Iterator[list[Word]]:
    """Yield the parts of some words between the words `at`, without empty parts."""
    for apart, part in itertools.groupby(words, key=lambda word: word.low in at):
        if not apart:
            yield list(part)


def _being(reader: Utterance, preposition: Word, when: str = "") -> nlp.Statement:
    nouns = reader.tree.children(preposition, "pobj")
    return _statement(phrase_of(reader.tree, nouns[0]) if nouns else Phrase(""), when)


def _statement(object: Phrase, when: str = "") -> nlp.Statement:
    return nlp.Statement(nlp.Triple("I", f"be{when}", object.text), _I, object, "be", (object,))
