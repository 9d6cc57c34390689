"""Phrases of the listening skill, and the *moments* (situations in a conversation) that they answer."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .state import LASTING

ROLE = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class Line:
    """A phrase. It may have placeholders in braces, the *roles*: ``How old {are} {they}?``"""

    text: str
    roles: frozenset[str]
    """The names of the roles in `text` and `then`, in lower case. The phrase is used only if all their values are known."""
    then: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The kind of the user's answer (``yes``, ``no``, ``unsure`` or ``any``) → the agent's reactions to it."""
    start: str = ""
    """The kind of performance that begins if the user answers yes."""

    @property
    def asks(self) -> bool:
        """Whether the phrase ends with a question."""
        return self.text.endswith("?")


@dataclass(frozen=True, slots=True)
class Moment:
    """A situation in a conversation, and the groups of phrases for it."""

    name: str
    groups: Mapping[str, tuple[Line, ...]]
    tone: str = ""
    lasts: int = LASTING
    """The number of turns for which the tone lasts."""
    examples: tuple[str, ...] = ()
    nouns: frozenset[str] = frozenset()
    verbs: frozenset[str] = frozenset()
    """The nouns and the verbs that are typical of the situation."""
    moves: frozenset[str] = frozenset()
    """The moves of a listener (language/moves.py) that the phrases suit."""
    after: str = ""
    """A tag that the utterance must have; empty if it needs none. An utterance has the tag ``shown`` directly after the
    agent's joke, song, story or riddle."""
    least: float = 0.0
    """The minimum confidence in a move at which the phrases may be used."""
    heads: str = ""
    """The name of a list in heads.yaml. The utterance must have a word of this list."""
    follows: tuple[Moment, ...] = ()
    """The follow-ups: what the user may say directly after one of its phrases."""

    @property
    def words(self) -> frozenset[str]:
        """The nouns and the verbs."""
        return self.nouns | self.verbs

    def lines(self, *groups: str) -> list[Sequence[Line]]:
        """Return the groups with these names. Names without a group are left out."""
        return [self.groups[name] for name in groups if name in self.groups]


def roles_in(text: str) -> frozenset[str]:
    """Return the roles of a phrase. Equal sets are one object, because there are tens of thousands of phrases."""
    found = frozenset(role.lower() for role in ROLE.findall(text))
    return _shared.setdefault(found, found)


_shared: dict[frozenset[str], frozenset[str]] = {}
