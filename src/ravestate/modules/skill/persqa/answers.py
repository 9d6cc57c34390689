"""Bare answers to the agent's questions (*chess and football*), and corrections (*Bremen, not Hannover*)."""

from __future__ import annotations

import re

from ravestate.language.normal import plain
from ravestate.modules import nlp

from .kinds import is_remark, likeness
from .topics import NOUNS, TOPICS, WORDS, Fact, Topic, favourite
from .values import value_of


def _any(name: str) -> str:
    """Return a pattern that matches any phrase of a list in `WORDS`."""
    return "|".join(map(re.escape, sorted(WORDS[name], key=len, reverse=True)))


def _before(name: str) -> re.Pattern[str]:
    return re.compile(rf"^\W*(?:(?:{_any(name)})(?![\w'])[\s,.:;!…-]*)+", re.IGNORECASE)


_OPENERS, _CORRECTIONS = _before("openers"), _before("corrections")
_PREPOSITIONS = re.compile(
    r"^(?:(?:in|on|from|near|at|out of|for|with|as|of|to|outside|around|"
    r"(?:the )?(?:city|town|village|outskirts|suburbs?|edge|centre|center|north|south|east|west) of)\s+)+",
    re.IGNORECASE,
)
_LISTED = re.compile(r"\s*(?:[,;/&+]|\band\b|\bor\b|\bas well as\b|\bplus\b)\s*", re.IGNORECASE)
_END = re.compile(rf"[.;:!?…\n()\"]|\s(?:{_any('closers')}|(?:and )?(?:what about|how about|and) you)\b", re.IGNORECASE)
"""The end of an answer."""
LONG = 400
"""The maximum number of characters of an answer that are read: the patterns are slow for long texts."""
_ONE = (re.compile(","), re.compile(r",| and\b"))
_HEDGES = re.compile(
    r"^(?:(?:a bit of|a little|some|lots of|also|sometimes|mostly|maybe|just|both|to|then) )+", re.IGNORECASE
)
_PIECE = re.compile(
    r"[.!?;…]+\s+|,?\s(?:and|but|so) (?=(?:i|my|we|our|you|yours)\b)|,\s(?=(?:i|my|we|our|you|it|he|she|they|why|what|how|where|who)\b)",
    re.IGNORECASE,
)
"""The end of an answer that a clause follows: *hiking! And I'm in a club*."""
_CALL = re.compile(_PIECE.pattern.replace("|why|what|how|where|who", ""), re.IGNORECASE)
"""The same for a name. A question after it is no end, because the name may be a call: *Tom, where are you?*."""
_WHERE = re.compile(r"\s(?:in|at|from|for|on|near|by)\s(.+)$", re.IGNORECASE)
_PLACED = frozenset(["name", "people", "place", "work", "subject"])
"""Kinds of values that leave out a place after them: in *teacher at a school*, the value is *teacher*."""


def spelled_out(text: str) -> str:
    """Return a text with its short forms written out: *it's* as *it is*."""
    for form, full in ((r"n['’]t\b", " not"), (r"['’]m\b", " am"), (r"['’]re\b", " are"), (r"['’]d\b", " would")):
        text = re.sub(form, full, text)
    return re.sub(r"\b(it|that|he|she|there|name)['’]s\b", r"\1 is", text, flags=re.IGNORECASE).strip()


def answer(text: str, topic: str, seen: nlp.Analysis) -> list[Fact]:
    """Return the facts in a bare answer to a question about `topic`.

    Example:
        *chess and football* gives ``Fact("hobby", ("chess", "football"))``; *what?* gives nothing.
    """
    about = TOPICS[topic]
    text = " ".join(text[:LONG].split())
    said = re.sub(r"^(?:i am|we are|i)\s+", "", _OPENERS.sub("", text), flags=re.IGNORECASE)
    rest = _END.split(f" {_PREPOSITIONS.sub('', said)}", maxsplit=1)[0].strip(" ,-'")
    where = _WHERE.search(rest) if about.kind in _PLACED else None
    if where and about.kind in ("name", "people") and any(one.label in ("DATE", "TIME") for one in seen.entities):
        return []  # "exam on Monday"
    tells = {word.low for word in seen.tree.words if word.tag in ("VBD", "VBN") and word.text.islower()}
    low = rest.lower().split()
    if about.kind in ("name", "people") and len(low) > 1 and (tells & {low[0]} or low[-1] in WORDS["moments"]):
        return []  # "just made coffee"
    found = tuple(_values(rest[: where.start()] if where else rest, about, seen))
    if where and about.kind == "work" and rest[: where.start()].endswith("ing"):
        return []  # "looking for work"
    facts = [Fact(topic, found)] if found else []
    beside = next((one for one in TOPICS.values() if one.only_with == topic), None)
    if facts and where and beside and (place := value_of(where[1], beside, seen)):
        facts.append(Fact(beside.name, (place,)))
    return facts


def picked(topic: str, seen: nlp.Analysis) -> list[Fact]:
    """Return the only number, or the only name, in a loose answer: *older than you think: 83*, *same as ever, Ulm*."""
    about, words = TOPICS[topic], seen.tree.words
    if about.kind == "number":
        found = [word.text for word in words if word.pos == "NUM"]
        found = found if len(found) == 1 else []
    else:
        names = [word for word in words if word.pos == "PROPN"]
        runs = [word for word in names if seen.tree.before(word) not in names]
        only = about.kind in ("place", "organisation") and len(runs) == 1 and len(words) < 9
        only = only and (about.kind == "place" or runs[0].dep != "pobj")
        found = [" ".join(word.text for word in names)] if only else []
    return [Fact(topic, (value,)) for text in found if (value := value_of(text, about, seen, sure=True))]


def _values(rest: str, topic: Topic, seen: nlp.Analysis) -> list[str]:
    several = topic.many or topic.kind == "people"
    pieces = (
        [piece for piece in _LISTED.split(rest) if piece][:5]
        if several
        else [_ONE[topic.kind == "name"].split(rest)[0]]
    )
    found: list[str] = []
    for piece in pieces:
        value = value_of(
            _HEDGES.sub("", piece.strip()), topic, seen, sure=topic.kind != "place" and len(seen.tree.words) < 9
        )
        unlike = topic.kind == "activity" and len(piece.split()) > 2 and likeness(piece, topic.kind) < -0.1
        if value is None or len(value) < 2 or unlike or not any(map(str.isalnum, value)) or is_remark(value):
            break  # nothing after such a piece is a value
        found.append(value)
    return found


def self_asked(text: str, seen: nlp.Analysis) -> list[Fact]:
    """Return the fact in a question that users ask and answer themselves: *my hobby? Chess.*."""
    found = re.match(r"my (?:\w+ )??((?:favou?rite )?(\w+))\? +(?=\S)", text, re.IGNORECASE)
    topic = found and (favourite(found[1]) if " " in found[1] else NOUNS.get(found[2].lower(), ""))
    return answer(text[found.end() :], topic, seen) if found and topic else []


def opening(text: str, topic: str, seen: nlp.Analysis) -> list[Fact]:
    """Return the facts in the words before the first clause: *hiking! And I'm in a club*.

    If there are none, read the object of a clause about *it* or *that*: *at the moment that is Porto*.
    """
    ends = _CALL if topic == "name" else _PIECE
    pieces = [piece for piece in ends.split(text) if piece.strip(" ,.")]
    finite = {word.low for word in seen.tree.words if word.tag in ("VBD", "VBZ", "VBP", "MD")}
    for piece in pieces[:2] if len(pieces) > 1 else ():
        if finite & set(re.findall(r"[\w']+", spelled_out(piece.lower()))):
            break
        if any(plain(piece) == plain(act.text) for act in seen.acts.values()):
            continue  # "Good evening. I'm Ada."
        if facts := answer(piece, topic, seen):
            return facts
    for said in seen.statements:
        if TOPICS[topic].kind == "name" and said.holds and said.subject.names and said.verb in ("be", "do"):
            return answer(said.subject.text, topic, seen)  # "just Fenna is fine"
        if said.holds and said.verb == "be" and said.subject.text.lower() in ("it", "that") and said.object.text:
            owned = said.object.owner is not None or said.object.preposition or topic == "age"
            return [] if owned else answer(said.object.text, topic, seen)
    return []


def without_opening(text: str) -> str:
    """Return the words after *no*, *sorry* and the like; empty if a text has no such opening, or is an idiom."""
    opening = _CORRECTIONS.match(text)
    rest = text[opening.end() :] if opening else ""
    return "" if not rest or rest.lower().split()[0].strip(",.!") in WORDS["idioms"] else rest


def may_stand_alone(seen: nlp.Analysis, *, clear: bool = False) -> bool:
    """Return whether an utterance may be a bare answer. Sentences about others, requests, and a mere yes or no may not.

    Args:
        seen: The analysis of the utterance.
        clear: Whether the words are surely an answer, although they resemble a yes or no.
    """
    text = spelled_out(seen.text)
    rest = _OPENERS.sub("", text)
    if seen.yesno and not clear and (rest == text or not rest.strip()):
        return False  # "hard to say"
    said = {word.low for word in seen.tree.words}
    first = next((word.text for word in seen.tree.words), "")
    named = clear and first.istitle() and likeness(first, "name") > 0.3  # the parser takes *Rosalind* for a verb
    statements = [one for one in seen.statements if not (one.request and named)]
    return all(_may_answer(one) for one in statements if one.subject.person != "I" or said & {"i", "we", "i'm"})


def _may_answer(said: nlp.Statement) -> bool:
    if said.subject.person == "I":
        thinks = f"I {said.verb}" in WORDS["openers"]
        return thinks or (not said.plan and said.verb in ("be", *WORDS["likes"], *WORDS["pastimes"]))
    if said.subject.person == "you":
        return said.verb == "think"  # "older than you think: 83"
    pronouns = ("", "they", "these", "those", "he", "she")
    if said.subject.text.lower() in ("it", "that", "this"):
        return said.verb in ("be", "call", "name")  # not "it is raining"
    return said.subject.text.lower() in pronouns or said.subject.owner is not None
