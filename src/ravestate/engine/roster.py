"""A roster: the members of a large causal group by slot and by rule.

A thousand rules may hear one input. A question about one slot then concerns only the few members that write the slot,
and a roster finds these without a search. A group of few members needs no roster. The engine makes the roster of a
larger group at the first such question. From then on, `Group.join` and `Group.part` keep it up to date.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from ravestate.engine.activation import Activation
from ravestate.engine.group import Group
from ravestate.policy.causes import Causes
from ravestate.policy.model import RulePlan

FEW: Final = 8
"""A group with at most this many members needs no roster."""


class Roster:
    """The members of a causal group.

    Attributes:
        rules: Number of a rule → its activations in the group, the first to join first.
    """

    __slots__ = ("_causers", "_causes", "_count", "_places", "_writers", "rules")

    def __init__(self, causes: Causes, members: Iterable[Activation]) -> None:
        self._causes = causes
        self.rules: dict[int, dict[Activation, None]] = {}
        self._writers: dict[int, dict[Activation, None]] = {}  # slot → the members that write it
        self._causers: dict[int, dict[int, None]] = {}  # slot → the rules of members that may trigger its writers
        self._places: dict[Activation, int] = {}  # member → its place in the order of joining
        self._count = 0
        for member in members:
            self.enter(member)

    def enter(self, activation: Activation) -> None:
        """Add a new member."""
        rule = activation.clause.rule
        self._count += 1
        self._places[activation] = self._count
        for slot in rule.slots:
            self._writers.setdefault(slot, {})[activation] = None
        same = self.rules.setdefault(rule.index, {})
        if not same:
            for slot in self._causes.slots_behind(rule):
                self._causers.setdefault(slot, {})[rule.index] = None
        same[activation] = None

    def leave(self, activation: Activation) -> None:
        """Remove a member."""
        rule = activation.clause.rule
        del self._places[activation]
        for slot in rule.slots:
            del self._writers[slot][activation]
        same = self.rules[rule.index]
        del same[activation]
        if not same:
            del self.rules[rule.index]
            for slot in self._causes.slots_behind(self._causes.rules[rule.index]):
                del self._causers[slot][rule.index]

    def writers(self, slots: tuple[int, ...]) -> Iterable[Activation]:
        """Return the members that write one of the slots, the first to join first."""
        if len(slots) == 1:
            return self._writers.get(slots[0], {})
        found = {member for slot in slots for member in self._writers.get(slot, ())}
        return sorted(found, key=self._places.__getitem__)

    def causers(self, slots: tuple[int, ...]) -> list[RulePlan]:
        """Return the rules of the members that may trigger a writer of one of the slots."""
        found = dict.fromkeys([rule for slot in slots for rule in self._causers.get(slot, ())])
        return [self._causes.rules[rule] for rule in found]


def writers(group: Group, slots: tuple[int, ...], causes: Causes) -> Iterable[Activation]:
    """Return the members that may write one of the slots, the first to join first. In a small group, return all."""
    return group.members if group.count <= FEW else _roster(group, causes).writers(slots)


def causers(group: Group, slots: tuple[int, ...], causes: Causes) -> Iterable[RulePlan]:
    """Return the rules of the members that may trigger a writer of one of the slots. In a small group, return all."""
    if group.count <= FEW:
        return dict.fromkeys([member.clause.rule for member in group.members])
    return _roster(group, causes).causers(slots)


def by_rule(group: Group, causes: Causes) -> Mapping[int, Mapping[Activation, None]]:
    """Return the activations of the members, by the number of their rule."""
    if group.count > FEW:
        return _roster(group, causes).rules
    found: dict[int, dict[Activation, None]] = {}
    for member in group.members:
        found.setdefault(member.clause.rule.index, {})[member] = None
    return found


def _roster(group: Group, causes: Causes) -> Roster:
    roster = group.roster
    if roster is None:
        roster = group.roster = Roster(causes, group.members)
    return roster
