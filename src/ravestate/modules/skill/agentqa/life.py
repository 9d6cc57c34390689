"""An agent's life: facts about the agent, and topics that users may ask about. `read_life` reads a life from files."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from functools import lru_cache

Fact = str | tuple[str, ...] | tuple[tuple[str, str], ...]
"""A fact: one text, several texts, or pairs such as ``(("animal", "the octopus"),)``."""


@dataclass(frozen=True, slots=True)
class Topic:
    """A topic that people may ask or talk about, with the answers."""

    name: str
    questions: tuple[str, ...]
    """Example questions. Questions with the same meaning are understood as well."""
    phrases: tuple[str, ...]
    """Answers, with facts in braces. The agent chooses an answer whose facts are known."""
    otherwise: tuple[str, ...] = ()
    """Answers to use if every phrase needs an unknown fact. If `otherwise` is empty too, other modules answer."""
    named: tuple[tuple[str, tuple[str, ...]], ...] = ()
    """Pairs of a fact and answers. The answers suit a question that names a value of the fact. In an answer, ``{it}``
    stands for this value. If the value is a pair, ``{that}`` stands for its second text. If each of these answers needs
    an unknown fact, `phrases` answer."""
    unnamed: tuple[str, ...] = ()
    """Answers to a question about something particular (*can you dance*) that is not a value of a fact."""
    remarks: tuple[str, ...] = ()
    """Regular expressions for remarks, which only this module should answer. An expression matches whole words."""
    acts: tuple[str, ...] = ()
    """The user's acts and feelings that this topic answers, as `nlp.analysis` names them: ``insult``, ``grief``."""


@dataclass(frozen=True, slots=True)
class Life:
    """The agent's facts and topics, and questions that belong to no topic.

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
        """The agent's name."""
        return str(self.facts["name"])

    @property
    def born(self) -> date | None:
        """The agent's date of birth; None if it is not known."""
        born = self.facts.get("born")
        return None if born is None else date.fromisoformat(str(born))

    def __hash__(self) -> int:
        return hash((tuple(self.facts.items()), tuple(self.topics.values()), self.others))


@lru_cache(maxsize=1024)
def whole_words(expression: str) -> re.Pattern[str]:
    """Compile the expression of a remark so that it matches whole words.

    Each expression has a pattern of its own: in a pattern for several, groups of the same name would clash.

    Raises:
        re.error: `expression` is not a regular expression.
    """
    re.compile(expression)  # alone: with the brackets of the next line, "mad)|(sad" would be valid
    return re.compile(rf"(?<!\S)(?:{expression})(?!\S)")
