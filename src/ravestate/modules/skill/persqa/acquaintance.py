"""The user, as far as the agent knows him: in this talk, and in memory."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from ravestate.modules import ontology

from . import records
from .profile import Facts, merged, told_apart
from .talk import Talk
from .topics import NAME, in_order

__all__ = ["Acquaintance", "Noted"]


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

    def recall(self, graph: ontology.Graph) -> Acquaintance:
        """Ask memory what it has of him, whom it knows by his name, unless it was asked before."""
        if self.talk.met or self.who is None:
            return self
        found = graph.get(self.who.id) or records.named(graph, self.who[NAME])
        if found is None:
            return replace(self, talk=replace(self.talk, met=True, newcomer=True))
        remembered = records.known(graph, found)
        return Acquaintance(
            found,
            merged(remembered, self.facts),
            replace(self.talk, met=True, newcomer=False, remembered=remembered),
        )

    def noted(self, graph: ontology.Graph) -> Acquaintance:
        """Write down what he has told in this talk; nothing while his name is not known."""
        now = self.recall(graph)
        if now.who is None:
            return now
        remembered = now.talk.remembered
        new = {topic for topic, values in now.facts.items() if values != remembered.get(topic)}
        topics = in_order(new | now.talk.told)
        records.note(graph, now.who, {topic: now.facts.get(topic, ()) for topic in topics}, now._once)
        return now

    @property
    def _once(self) -> Facts:
        """All that memory may have of him on this talk's account, by topic."""
        remembered, once = self.talk.remembered, self.talk.once
        return {topic: remembered.get(topic, ()) + once.get(topic, ()) for topic in {**remembered, **once}}

    def renamed(self, graph: ontology.Graph, name: str) -> Acquaintance:
        """He is called otherwise than it was understood.

        Who was made in this talk has another name then. Who was remembered stays as he was before this talk, and what
        was told in it belongs to somebody else.
        """
        assert self.who is not None  # his name was understood
        if not self.talk.met:
            return replace(self, who=self.who.with_properties(name=name))
        if self.talk.newcomer:
            if records.named(graph, name) is None:
                return replace(self, who=self.who.with_properties(name=name))
            graph.forget(self.who)
        else:
            before = {topic: self.talk.remembered.get(topic, ()) for topic in self.talk.told}
            records.note(graph, self.who, before, self._once)
        return Acquaintance(
            ontology.Node("Person", {NAME: name}),
            told_apart(self.facts, self.talk.remembered, self.talk.told),
            replace(self.talk, met=False, newcomer=False, remembered={}, once={}, reminded=False),
        )

    def rebased(self, base: Acquaintance, after: Acquaintance) -> Acquaintance:
        """The user as he is now, with what has become of `base` in the meantime: `after`. What is not any more as it was at
        `base` stays as it is: the user has gone on talking."""
        same_user = (self.who, self.talk.met) == (base.who, base.talk.met)
        facts = dict(self.facts)
        for topic in {**base.facts, **after.facts}:
            if facts.get(topic) == base.facts.get(topic) != after.facts.get(topic):
                facts.pop(topic, None)
                if topic in after.facts:
                    facts[topic] = after.facts[topic]
        return Acquaintance(
            after.who if same_user else self.who,
            facts,
            self.talk.rebased(base.talk, after.talk) if same_user else self.talk,
        )


class Noted(NamedTuple):
    """What memory has made of the user."""

    base: Acquaintance
    """As he was known when it was asked."""
    after: Acquaintance
    """As he is known by what it answered."""
    called: str | None
    """By what name he was known before he said anything of it."""
