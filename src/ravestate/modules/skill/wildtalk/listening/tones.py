"""The tone of an utterance: sad, angry, glad, funny or tired; empty for none of these (language/examples/tones.yaml)."""

from __future__ import annotations

from ravestate.language.matcher import bundled_matcher

LEAST = {"sad": 0.7, "angry": 0.8, "glad": 0.75, "funny": 0.6, "tired": 0.75}
"""The least confidence in a tone. It is high, because most utterances of strangers have no clear tone: of 200 (tones_rows.tsv),
those above it were funny in 83 %, glad in 75 % and sad in 58 % of cases. Replies to each tone are chosen accordingly mild."""
DARK = ("sad", "angry", "tired")
DOUBT = 0.4
"""The confidence in a dark tone at which an utterance is probably no good news."""


def tone_of(text: str) -> str:
    """Return the tone of a text; empty if none is sure, and before `load_tones`, except for exact examples."""
    match = bundled_matcher("tones").match(text)
    return match.name if match is not None and match.score >= LEAST[match.name] else ""


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
