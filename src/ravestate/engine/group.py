"""A causal group: spikes with a common cause, and the decisions about them (laws L11, L15)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final

from ravestate.engine.roster import FEW, Roster
from ravestate.errors import EngineError
from ravestate.policy.causes import Causes
from ravestate.policy.model import RulePlan

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.spike import Spike


class Nothing(dict[Any, Any]):
    """An empty table that refuses entries, because all engines share it."""

    __slots__ = ()

    def __setitem__(self, key: Any, value: Any) -> None:
        raise EngineError("this empty table is shared: make a table before the first entry")

    def setdefault(self, key: Any, default: Any = None) -> Any:
        """Raise an error: this table refuses every entry."""
        self[key] = default

    def update(self, *args: Any, **entries: Any) -> None:
        """Raise an error: this table refuses all entries."""
        self["entries"] = args, entries

    def __ior__(self, value: Any) -> Any:  # type: ignore[misc]  # mypy compares this with `dict.__or__`
        """Raise an error: this table refuses all entries."""
        self.update(value)


NOTHING: Final[dict[Any, Any]] = Nothing()
"""The shared empty table. An attribute without entries has this value; before the first entry, replace it by a new
table."""

NO_NUMBERS: Final[frozenset[int]] = frozenset()
"""The shared empty set of numbers: the value of an attribute that seldom has members."""


class Group:
    """The slots that are taken in a causal group, and the activations that hold its spikes or wait for a change in it.

    Attributes:
        id: The group's number. Groups are numbered in the order in which they begin.
        taken: Key: the index of a slot that is taken in the group; value: the runs that hold the slot, or None if a
            run has finished with it.
        entries: The group's spikes that halves and benches keep. A *half* keeps a spike without an activation, until a
            second spike comes (``halves.py``). A *bench* keeps the second spike, too (``benches.py``). If the rules of
            a half write no slot, the half's spikes are left out, unless `Half.kin` is true.
        interested: The waiting activations that ask for consent again when something changes in the group
            (`State.dirty`).
        patience_ends: The rivals whose *stand-by* (activation without a spike) came under pressure (L16). Key: the
            index of the rival's clause; value: the time (seconds) at which the patience ends, possibly in the past.
        roster: An index of the group's `members` by slot and by rule (``roster.py``); None until a large group needs
            it.
        answers: Key: the index of a slot; value: the rule that first finished with the slot, and the number of that
            rule's activation. The engine fills this table only while it records a trace (`State.tracer`).
    """

    __slots__ = (
        "_member",
        "_others",
        "answers",
        "entries",
        "id",
        "interested",
        "into",
        "patience_ends",
        "roster",
        "taken",
    )

    def __init__(self, id: int) -> None:
        self.id = id
        self.into: Group | None = None  # the group into which this group has merged, if it has
        self._member: Activation | None = None  # most groups never have a second member, and need no table
        self._others: dict[Activation, None] = NOTHING
        # Most groups never need the following tables, so each table is created on first use.
        self.taken: dict[int, tuple[Activation, ...] | None] = NOTHING
        self.interested: dict[Activation, None] = NOTHING
        self.entries: dict[Spike, None] = NOTHING
        self.patience_ends: dict[int, float] | None = None
        self.roster: Roster[Activation] | None = None
        self.answers: dict[int, tuple[str, int]] = NOTHING

    def root(self) -> Group:
        """Return the group to which this group belongs now: itself, unless it has merged into another."""
        group = self
        while group.into is not None:
            group = group.into
        return group

    @property
    def members(self) -> tuple[Activation, ...]:
        """The activations that hold a spike of the group for a non-detached constraint, in the order in which they
        joined."""
        member = self._member
        if self._others:
            return tuple(self._others) if member is None else (member, *self._others)
        return () if member is None else (member,)

    @property
    def count(self) -> int:
        """The number of members."""
        return len(self._others) + (self._member is not None)

    def writers(self, slots: tuple[int, ...], causes: Causes) -> Iterable[Activation]:
        """Return the members that may write one of the slots, in the order in which they joined.

        A small group does not use a roster (an index of its members). The result is then all its members.
        """
        return self.members if self.count <= FEW else self._roster(causes).writers(slots)

    def causers(self, slots: tuple[int, ...], causes: Causes) -> Iterable[RulePlan]:
        """Return those of the members' rules that may trigger a rule that writes one of the slots.

        A small group does not use a roster (an index of its members). The result is then the rules of all its members.
        """
        if self.count <= FEW:
            return dict.fromkeys([member.clause.rule for member in self.members])
        return self._roster(causes).causers(slots)

    def by_rule(self, causes: Causes) -> Mapping[int, Mapping[Activation, None]]:
        """Return the members by the indices of their rules."""
        if self.count > FEW:
            return self._roster(causes).rules
        found: dict[int, dict[Activation, None]] = {}
        for member in self.members:
            found.setdefault(member.clause.rule.index, {})[member] = None
        return found

    def _roster(self, causes: Causes) -> Roster[Activation]:
        roster = self.roster
        if roster is None:
            roster = self.roster = Roster(causes, [(member, member.clause.rule) for member in self.members])
        return roster

    def has(self, activation: Activation) -> bool:
        """Return whether an activation is a member."""
        return activation is self._member or activation in self._others

    def join(self, activation: Activation) -> None:
        """Record that an activation holds a spike of the group for a non-detached constraint."""
        if self.has(activation):
            return
        if self._member is None and not self._others:
            self._member = activation
        elif self._others is NOTHING:
            self._others = {activation: None}
        else:
            self._others[activation] = None
        if self.roster is not None:
            self.roster.enter(activation, activation.clause.rule)

    def part(self, activation: Activation) -> None:
        """Record that an activation no longer holds a spike of the group for a non-detached constraint."""
        if activation is self._member:
            self._member = None
        elif activation in self._others:
            del self._others[activation]
        else:
            return
        if self.roster is not None:
            if self.count:
                self.roster.leave(activation, activation.clause.rule)
            else:
                self.roster = None

    def take(self, slot: int, holders: tuple[Activation, ...] | None) -> None:
        """Take a slot for the runs `holders`; None takes the slot for good. Runs of merged groups may share a slot."""
        if self.taken is NOTHING:
            self.taken = {slot: holders}
        else:
            self.taken[slot] = holders

    def free(self, slot: int, holder: Activation) -> None:
        """Free a slot that a run holds."""
        holders = self.taken.get(slot)
        if holders and holder in holders:
            left = tuple(other for other in holders if other is not holder)
            self.taken = {s: h for s, h in self.taken.items() if s != slot or left} or NOTHING
            if left:
                self.take(slot, left)

    def finished(self, slots: tuple[int, ...]) -> bool:
        """Return whether one of the slots is taken for good in this group."""
        taken = self.taken
        return bool(taken) and any(slot in taken and taken[slot] is None for slot in slots)

    def note(self, slots: tuple[int, ...], rule: str, activation: int) -> None:
        """Record that a run of `rule` has finished with `slots`; an earlier record about a slot stays."""
        self.answers = {**dict.fromkeys(slots, (rule, activation)), **self.answers}

    def answer(self, slots: tuple[int, ...]) -> tuple[str, int]:
        """Return the rule that finished with one of the slots, and its activation's number; or ``""`` and 0."""
        return next((self.answers[slot] for slot in slots if slot in self.answers), ("", 0))

    def concern(self, activation: Activation) -> None:
        """Make a waiting activation ask for consent again when something changes in this group (`State.dirty`)."""
        if self.interested is NOTHING:
            self.interested = {activation: None}
        else:
            self.interested[activation] = None

    def forget(self, activation: Activation) -> None:
        """Remove from `interested` an activation that no longer waits."""
        if activation in self.interested:
            self.interested.pop(activation)

    def enter(self, spike: Spike) -> None:
        """Record that a half or a bench keeps a spike of the group."""
        if self.entries is NOTHING:
            self.entries = {spike: None}
        else:
            self.entries[spike] = None

    def leave(self, spike: Spike) -> None:
        """Record that no half and no bench keeps the spike any longer."""
        if spike in self.entries:
            self.entries.pop(spike)

    def absorb(self, other: Group) -> None:
        """Make `other` part of this group. A slot that is taken for good in either group stays taken."""
        other.into = self
        for slot, holders in other.taken.items():
            mine = self.taken.get(slot, ())
            self.take(slot, None if mine is None or holders is None else mine + holders)
        self.roster = other.roster = None
        for activation in other.members:
            self.join(activation)
        for activation in other.interested:
            self.concern(activation)
        for spike in other.entries:
            self.enter(spike)
        if other.patience_ends:
            own = self.patience_ends or {}
            self.patience_ends = {
                **own,
                **{c: min(until, own.get(c, until)) for c, until in other.patience_ends.items()},
            }
        for activation in self.members:
            until = activation.patience_ends.get(other)
            if until is not None:
                activation.patience_ends[self] = min(until, activation.patience_ends.get(self, until))
        if other.answers:
            self.answers = {**other.answers, **self.answers}
        other._member = None
        other._others = NOTHING
        other.taken = other.interested = other.answers = other.entries = NOTHING

    def __repr__(self) -> str:
        return f"group {self.id}"
