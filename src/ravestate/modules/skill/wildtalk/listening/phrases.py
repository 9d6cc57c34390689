"""A phrase of the listening skill, its placeholders (*roles*), and the phrases that answer one kind of utterance."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

ROLE = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class Line:
    """A phrase. It may have placeholders in braces, the *roles*: ``I like {thing}.``"""

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
class Phrases:
    """The phrases that answer one kind of utterance."""

    name: str
    groups: Mapping[str, tuple[Line, ...]]
    """The name of a group → its phrases. The group ``say`` may always be used."""
    tone: str = ""
    words: frozenset[str] = frozenset()
    """The nouns and the verbs that are typical of such utterances."""

    def lines(self, *groups: str) -> list[Sequence[Line]]:
        """Return the groups with these names. Names without a group are left out."""
        return [self.groups[name] for name in groups if name in self.groups]


def filled(text: str, values: Mapping[str, str]) -> str:
    """Return a phrase with its roles filled. If a role begins with a capital (``{Thing}``), so does its value."""
    parts = ROLE.split(text)  # text, role, text, role, ...
    for place in range(1, len(parts), 2):
        value = values[parts[place].lower()]
        parts[place] = value[:1].upper() + value[1:] if parts[place][0].isupper() else value
    found = "".join(parts)
    return found[:1].upper() + found[1:]


def roles_in(text: str) -> frozenset[str]:
    """Return the roles of a phrase. Equal sets are one object, to save memory."""
    found = frozenset(role.lower() for role in ROLE.findall(text))
    return _shared.setdefault(found, found)


_shared: dict[frozenset[str], frozenset[str]] = {}
