"""Grade authored replies to an utterance, and find the kinds of reply that suit it.

A head of the network has learnt from the grades that readers gave to replies, and from utterances whose authors chose the
kinds that suit. ``tools/networks`` has both. The listening skill of the module wildtalk says the replies. `nlp` asks for
the kinds: a farewell calls for a reply of the kind ``leaves``.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from .head import Head
from .network import LONGEST, Network

REMEMBERED = 8
"""The number of texts whose grades are kept as mappings. A text takes 200 kB."""
GRADES, KINDS, LIKELY = "replies", "reply_kinds", "likely"
"""The grades of the replies and their labels; the kind of each reply; the probability of each reply's kind."""


class Replies(Head):
    """The head of the network that grades replies to a text. Thread-safe."""

    def __init__(self, source: Network | None = None) -> None:
        """Choose the network (by default, the bundled network); load nothing yet."""
        super().__init__(GRADES, source)
        self._latest = lru_cache(REMEMBERED)(self._graded)

    def grades(self, text: str, before: str = "", said: str = "") -> Mapping[str, tuple[float, float]]:
        """Return for each reply its expected grade, 0 to 2, and the probability of its kind.

        The result is empty before `load`, or for a blank text.

        Args:
            text: The utterance in normal form.
            before: The user's previous utterance in normal form; empty if there is none.
            said: The agent's last answer; empty if there is none.
        """
        text, before, said = text[:LONGEST], before[:LONGEST], said[:LONGEST]  # long texts would fill the cache
        return self._latest(text, before, said) if self.loaded else {}

    def kinds(self, text: str, before: str = "", said: str = "") -> Mapping[str, float]:
        """Return the probability of each kind of reply. For the arguments, see `grades`."""
        outputs = self._network.read(text[:LONGEST], before=before[:LONGEST], said=said[:LONGEST])
        return dict(zip(self._network.labels(KINDS), outputs[LIKELY].tolist(), strict=True)) if outputs else {}

    def _graded(self, text: str, before: str, said: str) -> Mapping[str, tuple[float, float]]:
        outputs = self._network.read(text, before=before, said=said)
        if not outputs:
            return {}
        return dict(zip(self.labels, zip(outputs[GRADES].tolist(), outputs[LIKELY].tolist(), strict=True), strict=True))


_REPLIES = Replies()


def replies() -> Replies:
    """Return the grades of the bundled network, which all contexts share. It may not be loaded yet."""
    return _REPLIES
