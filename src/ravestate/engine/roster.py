"""A roster: an index that finds the members of a large causal group by slot or by rule.

A causal group is a set of spikes with one cause. Its members are the activations that hold these spikes. A thousand
rules may hear one input, but often only a few of them write a certain slot. A roster finds these few without a search.
A group of few members needs no roster. The engine makes the roster of a larger group at the first such lookup. From
then on, `Group.join` and `Group.part` keep the roster up to date.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Generic, TypeVar

from ravestate.policy.causes import Causes
from ravestate.policy.model import RulePlan

Member = TypeVar("Member")

FEW: Final = 8
"""A group with at most this many members needs no roster."""


class Roster(Generic[Member]):
    """The members of a causal group. The class keeps the activations themselves, but looks only at the rule of each.

    Attributes:
        rules: Index of a rule → its activations in the group, in the order in which they joined.
    """

    __slots__ = ("_causers", "_causes", "_count", "_places", "_writers", "rules")

    def __init__(self, causes: Causes, members: Iterable[tuple[Member, RulePlan]]) -> None:
        self._causes = causes
        self.rules: dict[int, dict[Member, None]] = {}
        self._writers: dict[int, dict[Member, None]] = {}  # slot → the members that write it
        self._causers: dict[int, dict[int, None]] = {}  # slot → the members' rules that may trigger its writers
        self._places: dict[Member, int] = {}  # member → its place in the order of joining
        self._count = 0
        for member, rule in members:
            self.enter(member, rule)

    def enter(self, member: Member, rule: RulePlan) -> None:
        """Add a new member, an activation of `rule`."""
        self._count += 1
        self._places[member] = self._count
        for slot in rule.slots:
            self._writers.setdefault(slot, {})[member] = None
        same = self.rules.setdefault(rule.index, {})
        if not same:
            for slot in self._causes.slots_behind(rule):
                self._causers.setdefault(slot, {})[rule.index] = None
        same[member] = None

    def leave(self, member: Member, rule: RulePlan) -> None:
        """Remove a member, an activation of `rule`."""
        del self._places[member]
        for slot in rule.slots:
            del self._writers[slot][member]
        same = self.rules[rule.index]
        del same[member]
        if not same:
            del self.rules[rule.index]
            for slot in self._causes.slots_behind(self._causes.rules[rule.index]):
                del self._causers[slot][rule.index]

    def writers(self, slots: tuple[int, ...]) -> Iterable[Member]:
        """Return the members that write one of the slots, in the order in which they joined."""
        if len(slots) == 1:
            return self._writers.get(slots[0], {})
        found = {member for slot in slots for member in self._writers.get(slot, ())}
        return sorted(found, key=self._places.__getitem__)

    def causers(self, slots: tuple[int, ...]) -> list[RulePlan]:
        """Return those of the members' rules that may trigger a rule that writes one of the slots."""
        found = dict.fromkeys([rule for slot in slots for rule in self._causers.get(slot, ())])
        return [self._causes.rules[rule] for rule in found]
