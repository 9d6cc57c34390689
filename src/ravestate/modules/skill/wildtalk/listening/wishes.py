"""The performance that the user asks for (a joke, a song, a story or a game), and its subject."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ravestate.language.contractions import word_set
from ravestate.language.matcher import Match
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.tree import Tree, Word

from .state import State

LONGEST = 20
"""The maximum number of words of an utterance that accepts an offered performance. An utterance that asks for *another
one* may have half as many words."""
MOST = 400
"""The maximum number of characters that are read: the patterns take time that grows with the square of the length."""
LATELY = 3
"""*Another one* asks for a performance only if one of the agent's last answers, up to this number, was a performance."""
UNNAMED = 0.6
"""The minimum confidence in a request that does not name its performance: *hit me with a good one*."""

_SHARES = {"joke": ("knock",), "play": ("riddle", "chain", "animal")}
"""An act (what an utterance asks for, such as ``joke``) → the further performances that the utterance may mean."""
_HOLDER = re.compile(r"\b(?:think of|pick|choose) (?:an|some|any) animal\b")
"""The user asks the agent to think of an animal, which the user will guess."""
_GUESSER = re.compile(r"\b(?:i|i'll|i will) (?:think of|pick|choose|have) (?:an|some|any) animal\b")
"""The user says that they think of an animal, which the agent will guess."""
_ANOTHER = re.compile(
    r"\b(?:another(?: one)?(?! (?!one\b|please\b|pls\b|but\b|about\b|with\b|if\b|then\b|again\b)\w)|(?:one|1) more|(?:a )?new one"
    r"|next one|(?:(?:some|any) )?more of (?:those|them|that)|one (?:about|with|on)|(?:some|any) more|more please|encore)\b"
    r"|^\W*(?:(?:and|haha|lol|ok|please|once|yes|more|do it) )*(?:again|more)\W*(?:please)?\W*$",
    re.IGNORECASE,
)
_MORE = re.compile(
    r"^(?:\W*\w+\W+){0,2}(?:1|one|another|next|some) ?(?:more|one)?\W*(?:please|pls)?\W*$", re.IGNORECASE
)
"""A whole utterance that asks for another performance, even later: *meh, one more*."""
_SUBJECT = word_set("about with on of involving featuring")
_CORRECTS = re.compile(r"\bi (?:said|meant|mean|wanted|asked for|want)\b", re.IGNORECASE)
_OFFERED = re.compile(
    r"\b(?:shall|may|can|could) i\b[^.!]*\?$|\b(?:would|do) you (?:like|want)\b[^.!]*\?$|, then\?$|\bask me for\b|\bi have\b",
    re.IGNORECASE,
)
"""The agent offers a performance: *Shall I tell a story?*"""
_NOUNS = ("NOUN", "PROPN", "X")
_IN_IT = re.compile(r" (?:in|on) (?:it|them)$| please$")
_VAGUE = word_set("it one me that this them those us you something anything time please")
_PLAYED = re.compile(
    r"\bplay (?:an? )?(?:(?:game|round|match) of )?(?:some )?([a-z][a-z -]*?)(?: (?:with|against|together|now|please|then|instead|maybe|perhaps|too"
    r"|today|tonight)\b.*)?[?.! ]*$",
    re.IGNORECASE,
)
"""The game that the user wants to play: *can we play draughts together?*"""
_ANY = word_set("game games something anything it again that a the one with you me riddle riddles animal animals on")


@dataclass(frozen=True, slots=True)
class Wish:
    """A request for a performance."""

    kind: str
    """``joke``, ``song``, ``story``, ``riddle``, ``chain``, ``animal``, ``holder``, ``knock`` or ``play``.

    ``chain`` is word chain, and ``knock`` a knock-knock joke. In ``animal``, the agent guesses the user's animal; in
    ``holder``, the user guesses the agent's animal. ``play`` stands for a game of the user's choice.
    """
    thing: str = ""
    """The subject, in the user's words: *a green dragon*. For ``play``: the name of a game that the agent does not have."""
    words: tuple[str, ...] = ()
    """The nouns of the subject in their base form."""


def wish_in(shows: Mapping[str, Any], seen: Analysis, state: State, acts: Sequence[Match] = ()) -> Wish | None:
    """Return the performance that an utterance asks for; None if it asks for none.

    Args:
        shows: The performances, and the words that ask for them.
        seen: The analysis of the utterance.
        state: The state of the conversation, for *another one*, and for an offer of the agent.
        acts: The requests for performances that the classifier of acts finds in the utterance, the likeliest first.
    """
    low = seen.text.lower()[:MOST]
    kind = next(filter(None, (_asked(shows, act) for act in acts)), "")
    shown = bool(state.shown) and state.said[-1].endswith(state.shown[-1])  # a song may sing "I have ..."
    offered = state.said[-1] if state.said and not shown and _OFFERED.search(state.said[-1]) else ""
    accepted = offered and kinds_in(shows, offered) and not seen.yesno.no
    if accepted and not kind and len(low.split()) <= LONGEST:
        kind = next(iter((*kinds_in(shows, low), *(kinds_in(shows, offered) if seen.yesno.yes else ()))), "")
    lately = bool(state.shown) and any(one.endswith(state.shown[-1]) for one in state.said[-LATELY:])
    short = len(low.split()) <= LONGEST // 2
    if not kind and state.show and _MORE.search(low):
        kind = state.show
    if not kind and lately and short:
        corrected = shown and _CORRECTS.search(low)
        kind = state.show if _ANOTHER.search(low) or corrected else ""
        kind = (kinds_in(shows, low) or [kind])[-1] if corrected else kind  # "not a song, I wanted a joke"
    if not kind:
        return None
    if kind == "play":
        played = _PLAYED.search(low)
        words = frozenset(played[1].split()) if played else _ANY
        return Wish(kind, played[1] if played and not words & _ANY else "")
    noun = _subject(shows, seen.tree, low)
    if noun is None:
        return Wish(kind)
    parts = [word for word in seen.tree.subtree(noun) if not (word.dep in ("punct", "relcl") or word.low in _SUBJECT)]
    words = [word for word in parts if word.pos in _NOUNS or word is noun]
    lemmas = tuple(dict.fromkeys(word.lemma.lower() for word in words))
    return Wish(kind, _IN_IT.sub("", seen.tree.phrase(parts)), lemmas)


def kinds_in(shows: Mapping[str, Any], text: str) -> list[str]:
    """Return the performances that a text names, in their order in the text."""
    said = f" {' '.join(re.findall(r'[a-z]+', text.lower()))} "
    found = {
        kind: min((said.find(f" {one} ") for one in names if f" {one} " in said), default=-1)
        for kind, names in shows["names"].items()
    }
    return sorted((kind for kind, place in found.items() if place >= 0), key=lambda kind: found[kind])


def fitting(shows: Mapping[str, Any], wish: Wish, listed: Iterable[str]) -> list[str]:
    """Return the performances about a subject: those that name it, or else those with related words."""
    texts, low = list(listed), wish.thing.lower()
    exact = [one for one in texts if any(_has(one, word) for word in wish.words)]
    wider = [kind for kind, words in shows["subjects"].items() if any(_has(low, word) for word in (kind, *words))]
    names = {word for kind in wider for word in (kind, *shows["subjects"][kind])}
    return exact or [one for one in texts if any(_has(one, word) for word in names)]


def _has(text: str, word: str) -> bool:
    return re.search(rf"\b{re.escape(word)}(?:s|es)?\b", text, re.IGNORECASE) is not None


def _asked(shows: Mapping[str, Any], act: Match) -> str:
    """Return the performance that an act asks for; empty if the act is too doubtful."""
    named = kinds_in(shows, act.text)
    if act.score < UNNAMED and not named:
        return ""
    if act.name in named:  # "a joke, but no knock knock joke"
        return act.name
    low = act.text.lower()
    if act.name == "play" and (_GUESSER.search(low) or _HOLDER.search(low)):
        return "animal" if _GUESSER.search(low) else "holder"
    return next((kind for kind in named if kind in _SHARES.get(act.name, ())), act.name)


def _subject(shows: Mapping[str, Any], tree: Tree, low: str) -> Word | None:
    """Return the noun of the subject: *a story with a snail*, *a snail story*, *no, I said snails*."""
    about = [word for word in tree.words if word.low in _SUBJECT]
    own = {name for names in shows["names"].values() for name in names}
    found = [word for word in tree.children_of(about, "pobj", "pcomp") if word.low not in own]
    found = [word for word in found if word.low not in _VAGUE and word.pos in _NOUNS]
    after = [one for word in about for one in tree.words[word.index + 1 : word.index + 4]]
    found = found or [one for one in after if one.pos in _NOUNS and one.low not in _VAGUE][:1]
    nouns = [word for word in tree.words if word.low in own]
    found = found or [word for word in tree.children_of(nouns, "compound", "nmod") if word.low not in shows["plain"]]
    if not found and not nouns and _CORRECTS.search(low):
        found = [word for word in tree.words if word.dep == "dobj"]
    return next((word for word in found if word.low not in _VAGUE and word.pos in (*_NOUNS, "ADJ", "VERB")), None)
