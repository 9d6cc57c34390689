"""Recognise the feeling that fits the user's words."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence

from ravestate.language.acts import LONGEST, heard
from ravestate.language.feelings import addressed, feelings
from ravestate.language.matcher import bundled_matcher

from .feeling import Feeling

SHARED: Mapping[str, Feeling] = {
    "insult": "sad",
    "grief": "sad",
    "sadness": "sad",
    "loneliness": "sad",
    "illness": "sad",
    "affection": "affectionate",
    "compliment": "shy",
    "joy": "happy",
    "astonishing": "surprised",
}
"""The agent's feeling for each class of ``feelings.yaml``, the strongest first. It stays calm at the other classes."""

SPOILERS = frozenset({"failure", "anger", "worry"})
"""Classes beside which nothing is joyful: "I got my results, and I failed"."""

PICTURES: tuple[tuple[Feeling, re.Pattern[str]], ...] = (
    ("affectionate", re.compile("[❤💕💖💗💓💞💘💝💙💚💛💜🧡🤍🥰😍😘😚🤗🫂]|<3")),
    ("surprised", re.compile(r"[😮😲😯😱🤯😳]|(?<!\w)[:=]-?[oO]\b")),
    ("happy", re.compile(r"[😀😃😄😁😆🥳🎉🎊🤩]|(?<!\w):-?D\b")),
)


def recognise(text: str, names: Collection[str] = ()) -> Feeling | None:
    """Return the feeling that fits `text` (English), or None. The first call loads the sentence model.

    Args:
        text: The user's words; the first 1000 characters count.
        names: The agent's names: "Rosie is clever" means the same as "you are clever".

    Raises:
        PlatformError: The sentence model is missing, and the examples alone do not decide.

    Example:
        >>> recognise("You are so clever!"), recognise("You are not very clever."), recognise("I passed my exam!")
        ('shy', None, 'happy')
    """
    return feeling_in(to_agent(text, names)) or next(
        (f for f, picture in PICTURES if picture.search(text[:LONGEST])), None
    )


def to_agent(text: str, names: Collection[str] = ()) -> list[str]:
    """Return the sentences of `text` in the normal form, in which the agent is "you"."""
    return [addressed(sentence, names) for sentence in heard(text, names)]


def feeling_in(said: Sequence[str]) -> Feeling | None:
    """Return the strongest feeling in the sentences."""
    matcher = bundled_matcher("feelings")
    if not all(map(matcher.match_exactly, said)):
        matcher.load()
    found = feelings(said)
    if not SPOILERS.isdisjoint(found):
        found.pop("joy", None)
    return next((feeling for name, feeling in SHARED.items() if name in found), None)
