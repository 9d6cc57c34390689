"""Grade authored replies to an utterance, and find the kinds of reply that suit it.

A network (``replies.onnx``) has learnt from the grades that readers gave to replies, and from utterances whose authors
chose the kinds that suit. ``tools/networks`` has both. The listening skill of the module wildtalk says the replies.
`nlp` asks for the kinds: a farewell calls for a reply of the kind ``leaves``.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from .network import Network

LONGEST = 300
"""The maximum number of characters that the network reads."""
REMEMBERED = 8
"""The number of texts whose grades are kept, because modules may ask for a text again. A text takes 200 kB."""


class Replies(Network):
    """The network that grades replies to a text. Thread-safe."""

    def __init__(self, file: Path) -> None:
        """Choose a trained network; load nothing yet.

        Args:
            file: The ONNX file. Its metadata also has ``kinds``: the kind of each reply, with semicolons between them.
        """
        super().__init__(file)
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
        return self._latest(text, before, said) if self.loaded and text.strip() else {}

    def kinds(self, text: str, before: str = "", said: str = "") -> Mapping[str, float]:
        """Return the probability of each kind of reply. For the arguments, see `grades`."""
        grades = self.grades(text, before, said)
        likely = (chance for _, chance in grades.values())
        return dict(zip(self.about["kinds"].split(";"), likely, strict=True)) if grades else {}

    def _graded(self, text: str, before: str, said: str) -> Mapping[str, tuple[float, float]]:
        _, found = self.run(text, before=before, said=said)
        return dict(zip(self.labels, zip(*(one[0].tolist() for one in found), strict=True), strict=True))


_REPLIES = Replies(Path(__file__).with_name("replies.onnx"))


def replies() -> Replies:
    """Return the network, which all contexts share. It may not be loaded yet."""
    return _REPLIES
