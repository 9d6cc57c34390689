"""The tone of an utterance: sad, angry, glad, funny or tired; empty for none of these (language/examples/tones.yaml)."""

from __future__ import annotations

from collections.abc import Mapping

from ravestate.language.feelings import SORROWS
from ravestate.language.matcher import Match, bundled_matcher
from ravestate.modules.meta.nlp.analysis import Analysis

from .grave import is_grave
from .state import LASTING

LEAST = {"sad": 0.7, "angry": 0.8, "glad": 0.75, "funny": 0.6, "tired": 0.75}
"""Tone → the minimum confidence in it. The confidences are high, because most utterances of strangers have no clear tone.
In a test with 200 utterances (tones_rows.tsv), 83 % of those classified as funny were funny; for glad, 75 %; for sad, 58
%."""
DARK = ("sad", "angry", "tired")
FELT: Mapping[str, str] = {
    **dict.fromkeys(SORROWS, "sad"),
    "anger": "angry",
    "insult": "angry",
    "tiredness": "tired",
    "joy": "glad",
}
"""The name of a feeling → its tone."""
SURE, GLAD = 0.65, 0.8
"""`SURE`: the minimum confidence in a sad feeling. `GLAD`: the minimum confidence in any other feeling."""
LASTS, GRIEF = 5, 12
"""`LASTS`: the number of turns for which the tone of a feeling lasts. `GRIEF`: the same for grief in grave words."""
DOUBT = 0.4
"""From this confidence in a dark tone on, a glad feeling does not count."""


def tone_of(text: str) -> str:
    """Return the tone of a text; empty if no tone is sure. Before `load_tones`, only exact examples have a tone."""
    match = bundled_matcher("tones").match(text)
    return match.name if match is not None and match.score >= LEAST[match.name] else ""


def heard_tone(seen: Analysis) -> tuple[str, int]:
    """Return the tone of an utterance, and the number of turns for which it lasts.

    The tone is empty if none is sure. Sorrow takes precedence over the other feelings. A feeling takes precedence over the
    classifier of tones.
    """
    grave = is_grave(seen.normal.text)
    felt = [one for one in seen.feelings.values() if one.name in FELT and one.score >= _least(one)]
    best = max(felt, key=lambda one: (FELT[one.name] == "sad", one.score), default=None)
    tone = "sad" if grave else FELT[best.name] if best is not None else ""
    if tone == "glad" and may_be_dark(seen.text):  # "that's Portugal gone!" is no good news
        tone = ""
    if tone:
        return tone, GRIEF if grave and best is not None and best.name == "grief" else LASTS
    tone = tone_of(seen.text)
    glad = tone == "glad" and seen.move is not None and "rejoice" not in (seen.move.name, seen.move.second)
    return ("" if glad else tone), LASTING


def _least(feeling: Match) -> float:
    return SURE if FELT[feeling.name] == "sad" else GLAD


def may_be_dark(text: str) -> bool:
    """Return whether a text may be sad, angry or tired."""
    match = bundled_matcher("tones").match(text)
    return match is not None and match.name in DARK and match.score >= DOUBT


def load_tones() -> None:
    """Learn the examples.

    Raises:
        PlatformError: The sentence model is missing or broken.
    """
    bundled_matcher("tones").load()
