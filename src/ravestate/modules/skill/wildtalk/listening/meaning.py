"""The feelings, acts and moments in an utterance that may decide the answer, and their order."""

from __future__ import annotations

import re
from collections.abc import Sequence, Set

from ravestate.language.feelings import SORROWS
from ravestate.language.matcher import Match
from ravestate.modules.meta.nlp.analysis import Analysis

from .asked import Asked
from .asking import FEW_WORDS, kind_of
from .material import Material
from .moment import Moment
from .tones import may_be_dark, tone_of

SURE, MEANT = 0.85, 0.7
"""The minimum confidences at which a moment and an act decide the answer."""
EXACT = 0.97
"""The minimum confidence at which a moment decides the answer even if it suits no likely move."""
FINER = 0.1
"""The bonus of a moment over feelings and acts, because a moment is more specific."""
FELT, GLAD, AMAZED, NEVER = 0.65, 0.8, 0.9, 2.0
"""The minimum confidences at which a sad feeling, any other feeling, and astonishment decide the answer. No confidence
reaches `NEVER`."""
TURNED = 0.95
"""The minimum confidence at which a glad feeling or a moment that is not sad ends a sad tone."""
CLOUDED = 0.85
"""The minimum confidence at which a sad moment ends a glad tone."""
ASKED = 0.8
"""The minimum confidence in a request at which the agent follows it."""
FEW = 0.75
"""The minimum confidence in the act or the feeling of a short sentence."""
BRIEFLY = 5
"""The maximum number of words of a feeling about a relative or a pet, such as *my mother is ill*. Such feelings have
their own phrases, which take precedence over the bank."""
ENDINGS = ("stop", "quiet")
"""Acts that count only if their confidence is high."""
SAD = SORROWS | {"tiredness"}
"""The names of sad feelings."""


def meanings_of(
    phrases: Material,
    seen: Analysis,
    tone: str,
    moves: Sequence[str],
    moment: Moment | None,
    score: float,
    feeling: Moment | None,
    asking: str,
) -> list[Moment]:
    """Return the feelings, acts and moments that may decide the answer, best first.

    Args:
        phrases: The phrases.
        seen: The utterance.
        tone: The tone of the conversation.
        moves: The likely moves.
        moment: The moment that the utterance resembles most.
        score: The confidence in this moment.
        feeling: The strongest feeling.
        asking: The sentence that asks something, or an empty text.
    """
    ranked: list[tuple[float, Moment]] = []
    light = moment is not None and moment.tone != "sad" and "sad" not in moment.groups
    if moment is not None and tone == "sad" and light and (not asking or moment.tone == "glad"):
        score = (
            score if score >= TURNED and moment.tone == "glad" and "rejoice" in moves else 0.0
        )  # no light phrases in a sad conversation
    if moment is not None and tone == "glad" and moment.tone == "sad" and score < CLOUDED:
        score = 0.0  # "tears of joy"
    if feeling is not None and feeling.tone == "sad" and light and seen.feelings[feeling.name].score >= TURNED:
        score = 0.0  # "I must tell you, I am afraid"
    if moment is not None and score >= SURE:
        ranked.append((score + FINER, moment))
    if feeling is not None:
        ranked.append((seen.feelings[feeling.name].score, feeling))
    for act in (act for act in seen.acts.values() if act.name in phrases.acts):
        few, last = len(act.text.split()) <= FEW_WORDS, act.text in seen.sentences[-1:]
        least = ASKED if act.name in ENDINGS else FEW if few else MEANT
        whole = len(seen.sentences) == 1 and len(act.text) >= len(seen.sentences[0]) - 1
        beside = (
            act.text != asking or act.name in ("greeting", "farewell")
            if asking
            else few and not whole and not (last and act.name in ("farewell", "thanks"))
        )
        if act.score >= least and not beside and (fits_move(phrases.acts[act.name], moves) or (whole and few)):
            ranked.append((act.score, phrases.acts[act.name]))
    return [one for _, one in sorted(ranked, key=lambda pair: -pair[0])]


def fits_move(moment: Moment, moves: Sequence[str]) -> bool:
    """Return whether a moment has phrases for one of the likely moves."""
    return not moves or not moment.moves or not moment.moves.isdisjoint(moves)


def moment_of(
    phrases: Material, seen: Analysis, tags: Set[str], moves: Sequence[str], asked: Asked | None, asking: str = ""
) -> tuple[Moment | None, str, float]:
    """Return the moment that a sentence resembles most, with the sentence and the confidence.

    A moment counts if its phrases suit one of the likely moves, or if the user says one of its examples nearly word for
    word. If the user asks something, only the question counts.
    """
    best, sentence, score = None, "", 0.0
    imagined = any(one.conditional for one in seen.statements)
    texts = [asking] if asking else list(seen.sentences[:4])
    for match in (match for matcher in phrases.matchers for match in matcher.match_all(texts)):
        if match is None or match.score <= score:
            continue
        found = phrases.moments[match.name]
        few = len(match.text.split()) <= FEW_WORDS and len(seen.sentences) > 1  # "sorry" beside another sentence
        better = asked is not None and (asked.own or (tags >= {"sad"} and found.tone != "sad"))
        alike = asked is None or (not better and asked.kind == kind_of(match.example))
        fits = match.score >= EXACT or (alike and fits_move(found, moves) and not imagined)
        if fits and not few and (not found.after or found.after in tags) and has_head(phrases, found, seen):
            best, sentence, score = found, match.text, match.score
    return best, sentence, score


def has_head(phrases: Material, moment: Moment, seen: Analysis) -> bool:
    """Return whether an utterance has one of the words that a moment needs, as grief needs a word of death."""
    needed = phrases.heads.get(moment.heads, frozenset())
    return not needed or any(needed & {word.low, word.lemma.lower()} for word in seen.tree.words)


def feeling_of(phrases: Material, seen: Analysis, sentence: str, tone: str) -> tuple[Moment | None, str]:
    """Return the strongest feeling with its sentence; sad feelings precede all others."""
    known = [one for one in seen.feelings.values() if one.name in phrases.feelings and one.score >= _least(one, tone)]
    brief = len(seen.text.split()) <= BRIEFLY  # "the parcel lay in the rain again. Unbelievable." is no surprise
    known = [one for one in known if brief or one.name != "astonishing"]
    known = [one for one in known if has_head(phrases, phrases.feelings[one.name], seen)]
    known = [one for one in known if not re.search(rf'["“][^"”]*{re.escape(one.text.strip(".!?"))}', seen.text)]
    if may_be_dark(seen.text):  # "that's Portugal gone!" is no good news
        known = [one for one in known if phrases.feelings[one.name].tone != "glad"]
    elif tone_of(seen.text) == "funny":  # "I fell asleep on the tram, and now I am at a cemetery"
        known = [one for one in known if phrases.feelings[one.name].tone != "sad"]
    but = any(word.low == "but" for word in seen.tree.words)  # "you are sweet, but you don't listen"
    matches = [one for one in known if one.name in SAD or not but]
    if not matches:
        return None, sentence
    best = max(matches, key=lambda match: (match.name in SAD, match.score))
    return phrases.feelings[best.name], best.text


def _least(match: Match, tone: str) -> float:
    """Return the minimum confidence at which a feeling decides the answer."""
    few = len(match.text.split()) <= FEW_WORDS
    if match.name == "astonishing":
        return AMAZED if few else NEVER  # a longer utterance says what is astonishing
    least = FELT if match.name in SAD else TURNED if tone in ("sad", "angry") else GLAD
    return max(least, FEW) if few else least
