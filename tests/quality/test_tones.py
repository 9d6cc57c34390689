"""The tone of utterances: the share of right tones, and the share of dark utterances that count as cheerful.

A dark utterance is sad, angry or tired, and not funny.
"""

from __future__ import annotations

from quality import measure
from ravestate.modules.skill.wildtalk.listening.tones import load_tones, tone_of

RIGHT, CHEERFUL = 0.5, 0.1
"""The minimum share of right tones, and the maximum share of dark utterances with a cheerful tone."""


def test_most_tones_are_right_and_hardly_any_dark_utterance_counts_as_cheerful() -> None:
    load_tones()
    rows = [(text, label.split("|"), tone_of(text) or "-") for text, label in measure.labelled("tones_rows")]
    right = [tone in labels for _, labels, tone in rows]
    dark = [
        tone for _, labels, tone in rows if not {"sad", "angry", "tired"}.isdisjoint(labels) and "funny" not in labels
    ]
    assert sum(right) / len(right) >= RIGHT, [row for row, good in zip(rows, right, strict=True) if not good]
    assert dark.count("glad") + dark.count("funny") <= CHEERFUL * len(dark)
