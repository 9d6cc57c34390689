"""The user as the agent knows them: from this conversation, and from memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravestate.modules import ontology

from . import records
from .profile import Facts, merged, told_apart
from .talk import Talk
from .told import Told
from .topics import NAME, TOPICS, in_order
from .wording import alike, among


@dataclass(frozen=True, slots=True)
class Acquaintance:
    """The user, the facts about them, and the state of the conversation. Immutable.

    Attributes:
        who: The user's node; None while their name is not known.
        facts: Values by topic, without the name.
        talk: The state of the conversation.
        told: The user's free statements by key, oldest first.
    """

    who: ontology.Node | None
    facts: Facts
    talk: Talk
    told: Mapping[str, Told] = field(default_factory=dict[str, Told])

    @property
    def name(self) -> str | None:
        """The user's name."""
        return None if self.who is None else self.who.get(NAME)

    @property
    def known(self) -> Facts:
        """Values by topic, with the name."""
        return {NAME: (self.name,), **self.facts} if self.name else self.facts

    def recall(self, graph: ontology.Graph) -> Acquaintance:
        """Return the user with the facts that memory has under their name. Memory is asked once per conversation."""
        if self.talk.met or self.who is None or self.talk.doubt:
            return self
        found = graph.get(self.who.id) or records.named(graph, self.who[NAME])
        if found is None:
            return replace(self, talk=replace(self.talk, met=True, newcomer=True))
        remembered = records.known(graph, found)
        return Acquaintance(
            found,
            merged(remembered, self.facts),
            replace(self.talk, met=True, newcomer=False, remembered=remembered),
            {**records.remarks(graph, found), **self.told},
        )

    def doubted(self, graph: ontology.Graph) -> Acquaintance:
        """Return the user with a doubt, if memory knows facts about a person of the name that they have just told."""
        if self.talk.met or self.who is None:
            return self
        found = records.named(graph, self.who[NAME])
        facts = records.known(graph, found) if found is not None else {}
        if any(among(value, facts.get(topic, ())) for topic, values in self.facts.items() for value in values):
            return self  # they have just told something that this person told before
        topics = [topic for topic, values in facts.items() if values]
        topic = next((topic for topic in topics if TOPICS[topic].asked), topics[0] if topics else "")
        return replace(self, talk=replace(self.talk, doubt=topic)) if topic else self

    def settled(self, graph: ontology.Graph, answer: tuple[str, ...]) -> Acquaintance:
        """Return the user as the person of their name who told this answer, or as a new person."""
        assert self.who is not None
        topic, talk = self.talk.doubt, replace(self.talk, doubt="")
        for person in records.namesakes(graph, self.who[NAME]) if answer else ():
            values = records.known(graph, person).get(topic, ())
            if any(alike(value, values) for value in answer):
                return replace(self, who=person, talk=talk).recall(graph)
        return self.stranger()

    def stranger(self) -> Acquaintance:
        """Return the user as a new person, even if memory knows another one of their name."""
        return replace(self, talk=replace(self.talk, doubt="", met=True, newcomer=True))

    def noted(self, graph: ontology.Graph) -> Acquaintance:
        """Save what the user told in this conversation; nothing while their name is not known."""
        now = self.recall(graph)
        if now.who is None or now.talk.doubt:
            return now
        remembered = now.talk.remembered
        new = {topic for topic, values in now.facts.items() if values != remembered.get(topic)}
        topics = in_order(new | now.talk.told)
        records.note(graph, now.who, {topic: now.facts.get(topic, ()) for topic in topics}, now._once)
        records.note_remarks(graph, now.who, now.told)
        return now

    @property
    def _once(self) -> Facts:
        """All facts that this conversation may have put into memory, by topic."""
        remembered, once = self.talk.remembered, self.talk.once
        return {topic: remembered.get(topic, ()) + once.get(topic, ()) for topic in {**remembered, **once}}

    def renamed(self, graph: ontology.Graph, name: str) -> Acquaintance:
        """Return the user under another name, because the first one was misunderstood.

        A person that this conversation created is renamed. A person from memory gets their old facts back, and the
        facts of this conversation go to the new name.
        """
        assert self.who is not None  # the agent understood their name
        if not self.talk.met:
            renamed = ontology.Node("Person", {NAME: name})
            return replace(self, who=renamed, talk=replace(self.talk, doubt=""))
        if self.talk.newcomer:
            if records.named(graph, name) is None:
                return replace(self, who=self.who.with_properties(name=name))
            graph.forget(self.who)
        else:
            self.restored(graph)
        return Acquaintance(
            ontology.Node("Person", {NAME: name}),
            told_apart(self.facts, self.talk.remembered, self.talk.told),
            replace(self.talk, met=False, newcomer=False, remembered={}, once={}, reminded=False),
        )

    def restored(self, graph: ontology.Graph) -> None:
        """Give the person for whom the agent has mistaken the user their old facts back."""
        assert self.who is not None
        before = {topic: self.talk.remembered.get(topic, ()) for topic in self.talk.told}
        records.note(graph, self.who, before, self._once)

    def rebased(self, base: Acquaintance, after: Acquaintance) -> Acquaintance:
        """Return this state of the user with the changes from `base` to `after`.

        A field that has changed since `base` stays as it is, because the user has kept talking."""
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
            {key: one for key, one in {**after.told, **self.told}.items() if key not in base.told or key in after.told}
            if same_user
            else self.told,
        )


class Noted(NamedTuple):
    """The result of asking memory about the user, or of saving what they told."""

    base: Acquaintance
    """The user before memory was asked."""
    after: Acquaintance
    """The user with the answer of memory."""
    called: str | None
    """The user's name before this utterance."""
