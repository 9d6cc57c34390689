"""The tone of an utterance: sad, angry, glad, funny or tired; empty for none of these (language/examples/tones.yaml)."""

from __future__ import annotations

from ravestate.language.matcher import bundled_matcher

LEAST = {"sad": 0.7, "angry": 0.8, "glad": 0.75, "funny": 0.6, "tired": 0.75}
"""The minimum confidence in a tone. It is high, because most utterances of strangers have no clear tone. In a test with 200
utterances (tones_rows.tsv), 83 % of those classified as funny were funny; for glad, 75 %; for sad, 58 %. The less reliable
a tone is, the milder are the replies to it."""
DARK = ("sad", "angry", "tired")
DOUBT = 0.4
"""The minimum confidence in a dark tone at which an utterance does not count as good news."""


def tone_of(text: str) -> str:
    """Return the tone of a text; empty if no tone is sure. Before `load_tones`, only exact examples have a tone."""
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
