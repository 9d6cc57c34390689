"""Find out which feeling of the agent fits the user's words."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

from ravestate.language.acts import LONGEST, heard
from ravestate.language.addressing import addressed
from ravestate.language.feelings import SORROWS, feelings
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
"""Class in ``feelings.yaml`` → the agent's feeling. If a text has several classes, the first in this list counts. The
file's other classes raise no feeling."""

SPOILERS = frozenset({"failure", "anger", "worry"})
"""If one part of a text has one of these classes, the classes of `SPOILED` do not count: "I got my results, and I
failed"."""
SPOILED = frozenset({"joy", "affection", "astonishing"})
CLEAR = 0.65
"""The minimum confidence of a class of `SPOILED`. The minimum is high, because a smile at neutral words annoys users
more than no smile at good news."""

# Emoji and smileys in the user's words, and the agent's feeling for them.
PICTURES: tuple[tuple[Feeling, re.Pattern[str]], ...] = (
    ("affectionate", re.compile("[❤💕💖💗💓💞💘💝💙💚💛💜🧡🤍🥰😍😘😚🤗🫂]|<3")),
    ("surprised", re.compile(r"[😮😲😯😱🤯😳]|(?<!\w)[:=]-?[oO]\b")),
    ("happy", re.compile(r"[😀😃😄😁😆🥳🎉🎊🤩]|(?<!\w):-?D\b")),
)


def recognise(text: str, names: Collection[str] = ()) -> Feeling | None:
    """Return the feeling that fits the words of `text` (English), or else its emoji and smileys, or None.

    The first text with a sentence that equals no example in ``feelings.yaml`` loads the sentence model.

    Args:
        text: The user's words; the first 2000 characters count.
        names: The agent's names: "Rosie is clever" means the same as "you are clever".

    Raises:
        PlatformError: The sentence model is missing, and a sentence of the text equals no example.

    Example:
        >>> recognise("You are so clever!"), recognise("You are not very clever."), recognise("I passed my exam!")
        ('shy', None, 'happy')
    """
    said = heard(text, names)
    matcher = bundled_matcher("feelings")
    if not all(matcher.match_exactly(addressed(sentence, names)) for sentence in said):
        matcher.load()
    found = feelings(said, names)
    spoilt = SPOILED if not SPOILERS.isdisjoint(found) else frozenset[str]()
    for name, feeling in SHARED.items():
        if name in found and name not in spoilt and not (name in SPOILED and found[name].score < CLEAR):
            return feeling
    return next((feeling for feeling, picture in PICTURES if picture.search(text[:LONGEST])), None)


def sorrowful(text: str, names: Collection[str] = ()) -> bool:
    """Return whether a text shows one of the `SORROWS`, such as grief, illness, worry or anger.

    The matcher of feelings must be loaded.
    """
    return not SORROWS.isdisjoint(feelings(heard(text, names), names))
