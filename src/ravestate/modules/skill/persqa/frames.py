"""Find the topic of a value by the words around the value, for sentences that the table of topics does not list.

A stand-in of the same kind replaces the value, so only the words around it are compared with the examples in
``frames.yaml``. *I came into the world in Sousse* becomes *I came into the world in Rome*. This resembles *I entered this
world in Rome*.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase

from .answers import spelled_out
from .kinds import frames, kind_of
from .link import Link
from .links import NOW
from .topics import LASTING, NAME, WORDS
from .utterance import Utterance, is_former

_STAND_INS = {
    "place": "Rome", "workplace": "Siemens", "school": "Oxford", "job": "nurse", "person": "Anna", "activity": "chess",
    "studies": "physics", "thing": "pizza", "group": "the choir", "possession": "a car", "trait": "asthma",
    "trouble": "a headache", "place_of_day": "the shop",
}  # fmt: skip
"""A class of nouns → the stand-in for its nouns."""
_PROPER = ("place", "workplace", "person")
"""The classes to which a name may belong. The words around the name decide."""
_ASIDE = frozenset(["punct", "cc", "conj", "advcl", "parataxis", "intj", "mark", "meta", "dep", "npadvmod"])
_OWN = frozenset(["i", "me", "my", "mine"])
SURE = 0.6
"""The least confidence at which the words around a value tell a topic."""


def framed_in(reader: Utterance, said: nlp.Statement) -> Link | None:
    """Return the topic of a statement by the words around a value, with the phrase of this value."""
    clause = "" if said.question or said.request else _clause(reader, said)
    theirs = said.subject.head == "name" or _is_person(reader, said.subject)  # "my sister lives in Rome"
    if not _OWN & set(re.findall(r"[a-z]+", clause.lower())) or (theirs and said.object.person != "I"):
        return None
    if (
        said.verb == "call"
        or is_former(said.subject.text)
        or NOW - {"now"} & set(said.when.lower().split())
        or "right now" in reader.tree.text
    ):
        return None
    best: tuple[float, Link] | None = None
    for phrase in dict.fromkeys((said.object, said.subject, *said.phrases)):
        if not _may_be_value(reader, said, phrase):
            continue
        for match in filter(None, frames().match_all(list(_framed(reader, phrase, clause)))):
            fits = match.name != NAME or said.object.person == "I"  # "they call me Fish"
            fits = (
                fits and (match.name == "liking" or not said.negated) and not (said.past and match.name not in LASTING)
            )
            link = Link(match.name, phrase, sure=False)
            if fits and match.score > max(SURE, best[0] if best else 0.0) and reader.values(link):
                best = match.score, link
    return best[1] if best else None


def _may_be_value(reader: Utterance, said: nlp.Statement, phrase: Phrase) -> bool:
    described = said.verb == "be" and said.subject.person == "I" and phrase == said.object and not phrase.preposition
    other = phrase.person == "other" and not _is_person(reader, phrase) and phrase.owner is None
    return bool(phrase.text) and other and not described and phrase.text not in said.when


def _is_person(reader: Utterance, phrase: Phrase) -> bool:
    """Return whether a phrase names a relative, a friend or a pet: *my sister*, *a goldfish named Bubbles*."""
    return bool(reader.relative(phrase.head)) or phrase.head in WORDS["kin"]


def _framed(reader: Utterance, phrase: Phrase, clause: str) -> Iterator[str]:
    """Yield a clause with stand-ins for a phrase."""
    written = reader.written(phrase)
    if written not in clause:
        return
    own = kind_of(written)
    proper = bool(phrase.names) and not phrase.head
    for kind in (*_PROPER, *(["school"] if own == "school" else [])) if proper else (own,):
        if stand_in := _STAND_INS.get(kind):
            article = re.match(r"an? ", written) if kind == "job" else None
            yield clause.replace(written, (article[0] if article else "") + stand_in, 1)


def _clause(reader: Utterance, said: nlp.Statement) -> str:
    """Return the clause of a statement in the first person singular: *I have been in Oslo*."""
    tree, top = reader.tree, reader.verb(said)
    if top is None:
        return ""
    while top.dep in ("xcomp", "ccomp") and tree.head(top).lemma in ("love", "like", "get", "start", "begin", "keep"):
        top = tree.head(top)
    parts = [child for child in tree.children(top) if child.dep not in _ASIDE]
    text = spelled_out(tree.phrase([top, *(word for part in parts for word in tree.subtree(part))]))
    if said.when:
        text = text.replace(
            said.when, "for years" if re.match(r"(?:for|since|over)\b", said.when.lower()) else ""
        ).strip()
    text = re.sub(r"^we\b", "I", re.sub(r"\bour\b", "my", text), flags=re.IGNORECASE)
    return f"I {text}" if said.subject.person == "I" and not re.search(r"\bi\b", text, re.IGNORECASE) else text
