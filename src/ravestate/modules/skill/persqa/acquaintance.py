"""The user as the agent knows them: from this conversation, and from memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ravestate.modules import ontology

from . import records
from .profile import merged, told_apart
from .talk import Talk, unless_changed
from .told import Told
from .topics import NAME, TOPICS, in_order
from .wording import Facts, alike, among


@dataclass(frozen=True, slots=True)
class Acquaintance:
    """The user, the facts about them, and the state of the conversation. Immutable."""

    who: ontology.Node | None
    """The user's node; None while their name is not known."""
    facts: Facts
    """Values by topic, without the name."""
    talk: Talk
    told: Mapping[str, Told] = field(default_factory=dict[str, Told])
    """The user's free statements (which belong to no topic) by `Told.key`, oldest first."""

    @property
    def name(self) -> str | None:
        """The user's name."""
        return None if self.who is None else self.who.get(NAME)

    @property
    def known(self) -> Facts:
        """Values by topic, with the name."""
        return {NAME: (self.name,), **self.facts} if self.name else self.facts

    def recall(self, graph: ontology.Graph) -> Acquaintance:
        """Return the user with the facts that memory has under their name. Ask memory only once per conversation."""
        if self.talk.met or self.who is None or self.talk.doubt:
            return self
        found = graph.get(self.who.id) or records.named(graph, self.who[NAME])
        if found is None:
            return self.stranger()
        remembered = records.known(graph, found)
        returns = records.has_talked(graph, found)
        talk = replace(self.talk, met=True, newcomer=False, returns=returns, remembered=remembered)
        free = {**records.remarks(graph, found), **self.told}
        return Acquaintance(found, merged(remembered, self.facts), talk, free)

    def doubted(self, graph: ontology.Graph) -> Acquaintance:
        """Return the user. If memory knows facts about a person who may have this name, set `Talk.doubt`: the user must then
        prove that they are this person.

        If the user has just told one of these facts, they are this person, and there is no doubt.
        """
        if self.talk.met or self.who is None:
            return self
        people = [records.named(graph, self.who[NAME]), *records.candidates(graph, self.who[NAME])]
        person = next(filter(None, people), None)
        facts = records.known(graph, person) if person is not None else {}
        if any(among(value, facts.get(topic, ())) for topic, values in self.facts.items() for value in values):
            return replace(self, who=person)  # the user has just told a fact that memory knows about this person
        topics = sorted((topic for topic in facts if facts[topic]), key=lambda topic: not TOPICS[topic].asked)
        return replace(self, talk=replace(self.talk, doubt=topics[0] if topics else ""))

    def settled(self, graph: ontology.Graph, answer: tuple[str, ...]) -> Acquaintance:
        """Return the user as the person in memory who has this name and fits `answer`, or else as a new person."""
        assert self.who is not None
        for person in records.candidates(graph, self.who[NAME]):
            values = records.known(graph, person).get(self.talk.doubt, ())
            if any(alike(value, values) for value in answer):
                return replace(self, who=person, talk=replace(self.talk, doubt="")).recall(graph)
        return self.stranger()

    def stranger(self) -> Acquaintance:
        """Return the user as a new person, even if memory knows somebody of the same name."""
        return replace(self, talk=replace(self.talk, doubt="", met=True, newcomer=True))

    def noted(self, graph: ontology.Graph) -> Acquaintance:
        """Save what the user has told in this conversation. If their name is not known or in doubt, save nothing."""
        now = self.recall(graph)
        if now.who is None or now.talk.doubt:
            return now
        new = {topic for topic, values in now.facts.items() if values != now.talk.remembered.get(topic)}
        topics = in_order(new | now.talk.told)
        records.note(graph, now.who, {topic: now.facts.get(topic, ()) for topic in topics}, now.talk.ever)
        records.note_remarks(graph, now.who, now.told)
        return now

    def renamed(self, graph: ontology.Graph, name: str) -> Acquaintance:
        """Return the user under another name, because the agent misunderstood the name at first.

        If this conversation created the person, rename them, or use the person of that name in memory. If the person
        comes from memory, restore their old facts; the facts of this conversation then go to a person with the new name.
        """
        assert self.who is not None  # the agent understood their name
        person = ontology.Node("Person", {NAME: name})
        if not self.talk.met:
            return replace(self, who=person, talk=replace(self.talk, doubt=""))
        if not self.talk.newcomer:
            self.restored(graph)
        elif records.named(graph, name) is None:
            return replace(self, who=self.who.with_properties(name=name))
        else:
            graph.forget(self.who)
        facts = told_apart(self.facts, self.talk.remembered, self.talk.told)
        talk = replace(self.talk, met=False, newcomer=False, remembered={}, once={}, reminded=False)
        return Acquaintance(person, facts, talk)

    def restored(self, graph: ontology.Graph) -> None:
        """Restore the old facts of a person in memory whom the agent has mistaken for the user."""
        assert self.who is not None
        before = {topic: self.talk.remembered.get(topic, ()) for topic in self.talk.told}
        records.note(graph, self.who, before, self.talk.ever)

    def disowned(self, graph: ontology.Graph) -> None:
        """Remove the person whom this conversation created under a name that is not the user's."""
        assert self.who is not None
        graph.forget(self.who)

    def rebased(self, base: Acquaintance, after: Acquaintance) -> Acquaintance:
        """Return this state of the user with the changes from `base` to `after`.

        Parts of this state that already differ from `base` stay, because the user has spoken in the meantime."""
        facts = unless_changed(self.facts, base.facts, after.facts)
        if (self.who, self.talk.met) != (base.who, base.talk.met):  # by now, this is another user
            return replace(self, facts=facts)
        told = {
            key: one for key, one in {**after.told, **self.told}.items() if key not in base.told or key in after.told
        }
        return Acquaintance(after.who, facts, self.talk.rebased(base.talk, after.talk), told)


class Noted(NamedTuple):
    """The result of asking memory about the user, or of saving what they told."""

    base: Acquaintance
    """The user before memory was asked."""
    after: Acquaintance
    """The user after memory answered."""
    called: str | None
    """The user's name before this utterance."""
