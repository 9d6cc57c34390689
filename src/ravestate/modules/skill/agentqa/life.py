"""Who an agent is: facts, and topics that it may be asked about. Values; `read_life` has them from files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date

__all__ = ["Fact", "Life", "Topic"]

Fact = str | tuple[str, ...] | tuple[tuple[str, str], ...]
"""What is true: a text, several, or pairs, e.g. ``(("animal", "the octopus"),)``."""


@dataclass(frozen=True, slots=True)
class Topic:
    """Something that the agent may be asked, and what it says then."""

    name: str
    questions: tuple[str, ...]
    """Examples of how one asks. What is meant alike is understood alike."""
    phrases: tuple[str, ...]
    """What it says; facts stand in braces. One whose facts are known is chosen."""
    otherwise: tuple[str, ...] = ()
    """What it says when each of the phrases lacks a fact; without any it leaves the question to others."""
    named: tuple[tuple[str, tuple[str, ...]], ...] = ()
    """For a fact: what it says when the question names one of its values, ``{it}``; of pairs, ``{that}`` is the other one."""
    unnamed: tuple[str, ...] = ()
    """What it says when it is asked about something in particular (*can you dance*) that is no value of a fact."""
    remarks: tuple[str, ...] = ()
    """Regular expressions of whole words for what is said rather than asked, and is not to be left to anybody else."""
    asides: tuple[str, ...] = ()
    """Regular expressions of all that is said at once (*thanks a lot*); only if the agent has not asked anything."""


@dataclass(frozen=True, slots=True)
class Life:
    """Facts, topics, and questions that belong to none of them.

    Example:
        >>> from ravestate.modules.skill.agentqa.life_file import read_life
        >>> life = read_life()
        >>> life.name, life.facts["hobbies"][0]
        ('Ravestate', 'collecting words')
    """

    facts: Mapping[str, Fact]
    topics: Mapping[str, Topic]
    others: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """What the agent is called."""
        return str(self.facts["name"])

    @property
    def born(self) -> date | None:
        """When it was born, if that is known."""
        born = self.facts.get("born")
        return None if born is None else date.fromisoformat(str(born))

    def __hash__(self) -> int:
        return hash((tuple(self.facts.items()), tuple(self.topics.values()), self.others))
