"""Bare answers to a question of the agent's, and corrections: *hannover*, *chess and football*, *no, Bremen*."""

from __future__ import annotations

import re
from collections.abc import Collection
from functools import cache

from ravestate.language.contractions import WRITTEN
from ravestate.modules import nlp

from .kinds import is_remark
from .relations import relations
from .topics import TOPICS, Fact, Topic
from .values import value_of

_PREPOSITIONS = re.compile(
    r"^(?:(?:in|from|at|out of|for|with|as|of|to|(?:the )?(?:city|town|village) of)\s+)+", re.IGNORECASE
)
_LISTED = re.compile(r"\s*(?:[,;/&+]|\band\b|\bor\b|\bas well as\b|\bplus\b)\s*", re.IGNORECASE)
_FIRST = re.compile(r"[.;:!?…\n()\"]")
_END = re.compile(
    r"\s(?:but|because|since|so|when|while|if|that|which|who|where|though|although|until|as|with|i|i'm|you|we|it|my|not|is|was|are|has|have|"
    r"too|though|now|then|originally|currently|actually|mostly|of course|please|thanks|thank you|by the way|again|anyway|"
    r"(?:and )?(?:what about|how about|and) you(?:rs)?)\b.*$",
    re.IGNORECASE | re.DOTALL,
)  # fmt: skip
"""The words after an answer."""
_HEDGES = re.compile(
    r"^(?:(?:a bit of|a little|some|lots of|also|sometimes|mostly|maybe|just|both|to) )+", re.IGNORECASE
)
_WHERE = re.compile(r"\s(?:in|at|from|for|on|near|by)\s(.+)$", re.IGNORECASE)
_PLACED = frozenset(["name", "people", "place", "work", "subject"])
"""Kinds whose values contain no place: *teacher at a school*."""


@cache
def _before(name: str) -> re.Pattern[str]:
    phrases = sorted(relations().words[name], key=len, reverse=True)
    return re.compile(rf"^\W*(?:(?:{'|'.join(map(re.escape, phrases))})(?![\w'])[\s,.:;!…-]*)+", re.IGNORECASE)


def spelled_out(text: str) -> str:
    """Return a text with its short forms written out: *it's* as *it is*."""
    text = re.sub(r"\b(?:im|its|thats|dont|id)\b", lambda word: WRITTEN.get(word[0].lower(), word[0]), text)
    for form, full in ((r"n['’]t\b", " not"), (r"['’]m\b", " am"), (r"['’]re\b", " are"), (r"['’]d\b", " would")):
        text = re.sub(form, full, text)
    return re.sub(r"\b(it|that|he|she|there|name)['’]s\b", r"\1 is", text, flags=re.IGNORECASE)


def answer(text: str, topic: str, seen: nlp.Analysis) -> list[Fact]:
    """Return the facts in a bare answer to a question about `topic`.

    Example:
        *chess and football* gives ``Fact("hobby", ("chess", "football"))``; *what?* gives nothing.
    """
    about = TOPICS[topic]
    said = _before("openers").sub("", text)
    if "?" in re.split(r"[.!,;\n]", said, maxsplit=1)[0]:
        return []
    said = re.sub(r"^(?:i am|i'm|we are|i)\s+", "", said, flags=re.IGNORECASE)
    said = _before("openers").sub("", said)
    rest = _FIRST.split(_PREPOSITIONS.sub("", said).lstrip(" .,;:-\"'"), maxsplit=1)[0]
    rest = _END.sub("", f" {rest}").strip()
    where = _WHERE.search(rest) if about.kind in _PLACED else None
    if where:
        rest = rest[: where.start()]
    found = tuple(filter(None, _values(rest, about, seen)))
    facts = [Fact(topic, found)] if found else []
    beside = {"occupation": "employer", "subject": "university"}.get(topic)
    if facts and where and beside and (place := value_of(where[1], TOPICS[beside], seen)):
        facts.append(Fact(beside, (place,)))
    return facts


def _values(rest: str, topic: Topic, seen: nlp.Analysis) -> list[str | None]:
    several = topic.many or topic.kind == "people"
    pieces = [piece for piece in _LISTED.split(rest) if piece] if several else [re.split(r",", rest, maxsplit=1)[0]]
    found: list[str | None] = []
    for piece in pieces[:5]:
        value = value_of(_HEDGES.sub("", piece.strip()), topic, seen, sure=topic.kind != "place")
        if value is None or not any(map(str.isalnum, value)) or is_remark(value):
            break  # nothing after such a piece is a value
        found.append(value)
    return found


_NOT_THIS = re.compile(
    r"^\W*(?:(?:no|it is|i am|i)\W+)*not (?P<wrong>.+?)[,;.]\s*(?:(?:but|it is|i am|rather) )*(?P<right>.+)$",
    re.IGNORECASE,
)
_NOT_THAT = re.compile(r"^(?:no\W+)?(?:(?:it is|i am) )?(?P<right>.+?)[,;]? not (?P<wrong>\w.*)$", re.IGNORECASE)


def correction(
    text: str, topic: str, known: Collection[str], seen: nlp.Analysis, *, explicit: bool = False
) -> list[Fact]:
    """Return the facts in a correction: *no, Bremen*, *Bremen, not Hannover*.

    Args:
        text: The utterance, short forms written out.
        topic: The topic to correct.
        known: The values that were understood.
        seen: The analysis of the utterance.
        explicit: Whether only *Bremen, not Hannover* counts, and a mere *no, Bremen* does not.
    """
    if both := _NOT_THIS.match(text) or _NOT_THAT.match(text):
        wrong = _PREPOSITIONS.sub("", both["wrong"]).strip(" .!?").casefold()
        right = _before("corrections").sub("", both["right"])
        return answer(right, topic, seen) if wrong in {value.casefold() for value in known} else []
    opening = None if explicit else _before("corrections").match(text)
    rest = text[opening.end() :] if opening else ""
    if not rest or rest.lower().split()[0].strip(",.!") in relations().words["idioms"]:
        return []
    return answer(rest, topic, seen)


def may_stand_alone(seen: nlp.Analysis) -> bool:
    """Return whether an utterance may be a bare answer: not a sentence about others, a request, or adverbs alone."""
    opening = _before("openers").match(spelled_out(seen.text))
    if seen.yesno and not (opening and seen.text[opening.end() :].strip()):
        return False  # hard to say
    words = [word for word in seen.tree.words if word.pos != "PUNCT"]
    if words and not {word.pos for word in words} & {"NOUN", "PROPN", "VERB", "ADJ", "NUM", "X", "SYM", "INTJ"}:
        return False
    if len(words) < 3:
        return True  # Bill Gates is not a sentence, although a parser may make one of it
    said = {word.low for word in words}
    return all(
        _may_answer(one) for one in seen.statements if one.subject.person != "I" or said & {"i", "we", "i'm", "im"}
    )


def _may_answer(said: nlp.Statement) -> bool:
    subject = said.subject
    if subject.person == "you":
        return said.verb in relations().words["pastimes"]
    if subject.person == "I":
        if f"i {said.verb}" in map(str.lower, relations().words["openers"]):
            return True
        return not said.plan and said.verb in ("be", *relations().words["likes"], *relations().words["pastimes"])
    return (
        subject.text.lower() in ("", "it", "that", "this", "they", "these", "those", "he", "she")
        or subject.owner is not None
    )
