"""A phrase: the subject or object of a statement, or another noun phrase of its clause."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Person = Literal["I", "you", "other"]
"""The speaker (*I, my, we*), the agent (*you, your*), or others."""


@dataclass(frozen=True, slots=True)
class Phrase:
    """A noun phrase with the parts that skills use.

    Example:
        *my two sisters* has the head ``sister``, the owner *my* (person ``I``), and the amount 2. *my sister Rosa* has
        the head ``sister`` and the name ``Rosa``; *Rosa* has no head.
    """

    text: str
    """As in the triple: ``my sister Rosa``."""
    head: str = ""
    """The lemma of the common noun or adjective, in lower case: ``sister``; empty for names and pronouns."""
    names: tuple[str, ...] = ()
    """The names in the phrase, as written: ``("Rosa",)``; *two brothers, Max and Tim* has two."""
    owner: Phrase | None = None
    """The possessor: *my*; *my mother* for *my mother's name*; *Peru* for *the capital of Peru*."""
    amount: float | None = None
    """The number before the head: 2 for *two sisters*, 0 for *no sisters*, 34 for *34 years old*."""
    person: Person = "other"
    """``I`` and ``you`` for pronouns; ``other`` for everything else, also for *my sister*."""
    preposition: str = ""
    """The preposition before it, in lower case: ``in``."""

    @property
    def name(self) -> str:
        """The first name, or an empty string."""
        return self.names[0] if self.names else ""

    def of(self, person: Person) -> bool:
        """Return whether it belongs to `person`: *my sister* and *my mother's name* to ``I``."""
        return self.owner is not None and (self.owner.person == person or self.owner.of(person))
