"""Find the kinds of reply that suit an utterance: *you can be proud of that*, *what a shame*...

Similar words may need opposite replies: *my goldfish swims upside down* is no joke. So a small network
(``responses.onnx``, trained in ``tools/networks``) learnt from thousands of utterances, for each of which readers chose
the kinds of reply that suit, and the kinds that only seem to suit.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ravestate.language.classifier import Classifier

from .material import Material
from .moment import Moment

LEAST = 0.2
"""The minimum probability at which a reply of a kind is said. Below, a sign of listening is better."""
SURE = 0.5
"""The minimum probability at which a kind takes precedence over the bank."""
LIGHT = ("glad", "funny")
"""The tones of kinds that do not suit a sad or grave utterance."""


def responses_to(phrases: Material, text: str, *, dark: bool) -> list[tuple[float, Moment]]:
    """Return the kinds of reply that suit an utterance in normal form, the best first, with their probabilities.

    None before the network is loaded. `dark` says whether the utterance is sad or grave.
    """
    found = ((chance, phrases.responses[name]) for name, chance in network().ranked(text) if chance >= LEAST)
    return [(chance, kind) for chance, kind in found if not (dark and kind.tone in LIGHT)]


@cache
def network() -> Classifier:
    """Return the network, which all contexts share. It may not be loaded yet."""
    return Classifier(Path(__file__).with_name("responses.onnx"))
