"""Recognise the user's wish that the agent remember or forget their face."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from typing import Literal

from ravestate.language.acts import heard
from ravestate.language.examples import read_examples
from ravestate.language.matcher import Matcher, bundled_matcher

_ABOUT = re.compile(r"\b(?:faces?|looks?)\b", re.IGNORECASE)


def wish_of(text: str) -> Literal["forget", "remember", ""]:
    """Return whether an utterance asks the agent to ``forget`` or to ``remember`` the user's face, or neither ("").

    Without the sentence model, only sentences that equal an example in ``wishes.yaml`` count.

    Example:
        >>> wish_of("forget my face"), wish_of("I forget where I live")
        ('forget', '')
    """
    if not _ABOUT.search(text):
        return ""
    said = heard(text)
    if bundled_matcher("acts").loaded:  # otherwise, only sentences that equal an example count
        _wishes().load()
    found = {match.name for match in _wishes().match_all(said) if match is not None}
    return "forget" if "forget" in found else "remember" if "remember" in found else ""


@cache
def _wishes() -> Matcher:
    read = read_examples(files(__package__ or "") / "wishes.yaml")
    return Matcher(read.classes, read.none)
