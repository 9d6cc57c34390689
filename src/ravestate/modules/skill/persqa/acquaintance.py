"""The user, as far as the agent knows him: in this talk, and in memory."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ravestate.errors import PlatformError
from ravestate.modules import ontology

from . import records
from .profile import Facts, merged, told_apart
from .talk import Talk
from .topics import NAME, TOPICS

__all__ = ["Acquaintance"]


@dataclass(frozen=True, slots=True)
class Acquaintance:
    """Who the user is, what is known of him, and how the talk about that stands. It never changes.

    Attributes:
        who: His node; None while his name is not known.
        facts: Values by topic, but for the name.
        talk: How the talk stands.
    """

    who: ontology.Node | None
    facts: Facts
    talk: Talk

    @property
    def name(self) -> str | None:
        """His name."""
        return None if self.who is None else self.who.get(NAME)

    @property
    def known(self) -> Facts:
        """Values by topic, the name among them."""
        return {NAME: (self.name,), **self.facts} if self.name else self.facts

    async def recall(self, memory: ontology.Memory | None) -> Acquaintance:
        """Ask memory who bears his name, unless it was asked before.

        Raises:
            PlatformError: There is no memory, or it fails.
        """
        if self.talk.met or self.who is None:
            return self
        if memory is None:
            raise PlatformError("there is no memory")
        found = await records.named(memory, self.who[NAME])
        if found is None:
            return replace(self, talk=replace(self.talk, met=True, newcomer=True))
        remembered = await records.known(memory, found)
        return Acquaintance(
            found,
            merged(remembered, self.facts),
            replace(self.talk, met=True, newcomer=False, remembered=remembered),
        )

    async def noted(self, memory: ontology.Memory | None) -> Acquaintance:
        """Write down what he has told in this talk; nothing while his name is not known.

        Raises:
            PlatformError: There is no memory, or it fails.
        """
        if self.who is None:
            return self
        now = await self.recall(memory)
        assert memory is not None and now.who is not None  # else recall had raised
        new = {topic for topic, values in now.facts.items() if values != now.talk.remembered.get(topic)}
        topics = [topic for topic in TOPICS if topic in new | now.talk.told]
        await records.note(memory, now.who, {topic: now.facts.get(topic, ()) for topic in topics})
        return now

    async def renamed(self, memory: ontology.Memory | None, name: str) -> Acquaintance:
        """He is called otherwise than it was understood.

        Who was made in this talk has another name then. Who was remembered stays as he was before this talk, and what
        was told in it belongs to somebody else.

        Raises:
            PlatformError: Memory fails.
        """
        assert self.who is not None  # his name was understood
        if memory is None or not self.talk.met:
            return replace(self, who=self.who.with_properties(name=name))
        other = await records.named(memory, name)
        if self.talk.newcomer and other is None:
            return replace(self, who=self.who.with_properties(name=name))
        if self.talk.newcomer:
            await memory.forget(self.who)
        else:
            before = {topic: self.talk.remembered.get(topic, ()) for topic in self.talk.told}
            await records.note(memory, self.who, before)
        return Acquaintance(
            ontology.Node("Person", {NAME: name}),
            told_apart(self.facts, self.talk.remembered, self.talk.told),
            replace(self.talk, met=False, newcomer=False, remembered={}, reminded=False),
        )
