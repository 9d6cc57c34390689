"""Find the kinds of reply that suit an utterance: *you can be proud of that*, *what a shame*...

Similar words may need opposite replies: *my goldfish swims upside down* is no joke. A small network (``responses.onnx``)
has learnt from thousands of utterances which kinds suit, and which only seem to suit. ``tools/networks`` has these
utterances.
"""

from __future__ import annotations

from pathlib import Path

from ravestate.language.classifier import Classifier

from .material import PREFIX, Material
from .moment import Moment

LEAST = 0.15
"""The minimum probability at which a reply of a kind is said. Below, a sign of listening is better."""
SURE = 0.25
"""The minimum probability at which a kind of reply may take precedence over the bank, unless it is in `GENERAL`. See the
tag `responsive` in hearing.py."""
GENERAL = frozenset(("asks_fact", "asks_feeling", "asks_advice", "asks_favour", "tells_on", "answers", "nonsense"))
"""Kinds of reply that say little. They never take precedence over the bank."""
LIGHT = ("glad", "funny")
"""The tones of cheerful and funny replies."""
_NETWORK = Classifier(Path(__file__).with_name("responses.onnx"))


def responses_to(phrases: Material, text: str, before: str = "", *, dark: bool) -> list[tuple[float, Moment]]:
    """Return the kinds of reply that suit an utterance, the best first, with their probabilities.

    Before the network is loaded, there are none.

    Args:
        phrases: The replies.
        text: The utterance in normal form.
        before: The user's previous utterance in normal form; empty if there is none.
        dark: Whether the utterance or the conversation is sad or grave. If so, there are no cheerful or funny replies.
    """
    ranked = network().ranked(text, before)
    found = ((chance, phrases.responses[name]) for name, chance in ranked if chance >= LEAST)
    return [(chance, kind) for chance, kind in found if not (dark and kind.tone in LIGHT)]


def surely_suits(found: list[tuple[float, Moment]], least: float = SURE) -> bool:
    """Return whether the best of the kinds takes precedence over the bank, because its probability is at least `least`."""
    return bool(found) and found[0][0] >= least and not is_general(found[0][1])


def is_general(kind: Moment) -> bool:
    """Return whether the replies of a kind say little."""
    return kind.name.removeprefix(PREFIX) in GENERAL


def network() -> Classifier:
    """Return the network, which all contexts share. It may not be loaded yet."""
    return _NETWORK
