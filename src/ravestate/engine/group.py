"""A causal group: spikes with a common cause, and what has been decided about them (L11, L15)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation

__all__ = ["Group"]

NOTHING: Any = MappingProxyType[Any, Any]({})


class Group:
    """Which slots are taken in it, and which activations have a stake in it.

    Attributes:
        taken: For each slot taken here: who runs on it, or None once somebody has finished.
        members: The activations that hold non-detached spikes of it, oldest first; with how many.
        interested: The waiting activations to be asked again when something ends in it.
        pressed: Stand-by rivals (numbers of clauses) under pressure: until when they have patience (seconds).
        eliminated: Stand-by rivals whose patience has run out.
        answers: For slots that are taken for good: the rule that finished first and the number of its run, as far as
            somebody listened. It is only told.
    """

    __slots__ = ("answers", "eliminated", "id", "interested", "into", "members", "pressed", "taken")

    def __init__(self, id: int) -> None:
        self.id = id
        self.into: Group | None = None  # the group that this one has merged into
        self.members: dict[Activation, int] = {}
        # Most groups never need the following: they are made when they do.
        self.taken: Mapping[int, tuple[Activation, ...] | None] = NOTHING
        self.interested: Mapping[Activation, None] = NOTHING
        self.pressed: dict[int, float] | None = None
        self.eliminated: set[int] | None = None
        self.answers: Mapping[int, tuple[str, int]] = NOTHING

    def root(self) -> Group:
        """The group that this one belongs to now."""
        group = self
        while group.into is not None:
            group = group.into
        return group

    def take(self, slot: int, holders: tuple[Activation, ...] | None) -> None:
        """A slot is taken by a run (by several, if their groups have merged), or (None) for good."""
        if self.taken is NOTHING:
            self.taken = {slot: holders}
        else:
            self.taken[slot] = holders  # type: ignore[index]  # it is a dictionary from then on

    def free(self, slot: int, holder: Activation) -> None:
        """A run gives a slot back, if it has it."""
        holders = self.taken.get(slot)
        if holders and holder in holders:
            left = tuple(other for other in holders if other is not holder)
            self.taken = {s: h for s, h in self.taken.items() if s != slot or left} or NOTHING
            if left:
                self.take(slot, left)

    def finished(self, slots: tuple[int, ...]) -> bool:
        """Whether one of the slots is taken for good."""
        taken = self.taken
        return bool(taken) and any(slot in taken and taken[slot] is None for slot in slots)

    def note(self, slots: tuple[int, ...], rule: str, run: int) -> None:
        """A run of a rule finishes on slots; what finished on them before stays noted."""
        self.answers = {**dict.fromkeys(slots, (rule, run)), **self.answers}

    def answer(self, slots: tuple[int, ...]) -> tuple[str, int]:
        """The rule, and the number of its run, that finished on one of the slots; nobody (``""``, 0) if it is not noted."""
        return next((self.answers[slot] for slot in slots if slot in self.answers), ("", 0))

    def concern(self, activation: Activation) -> None:
        """Ask a waiting activation again when something ends here."""
        if self.interested is NOTHING:
            self.interested = {activation: None}
        else:
            self.interested[activation] = None  # type: ignore[index]  # as above

    def forget(self, activation: Activation) -> None:
        """An activation waits no longer."""
        if activation in self.interested:
            self.interested.pop(activation)  # type: ignore[attr-defined]  # as above

    def eliminate(self, clause: int) -> None:
        """The patience of a stand-by rival has run out."""
        if self.eliminated is None:
            self.eliminated = set()
        self.eliminated.add(clause)

    def absorb(self, other: Group) -> None:
        """Make `other` part of this group. What is finished in either is finished in both."""
        other.into = self
        for slot, holders in other.taken.items():
            mine = self.taken.get(slot, ())
            self.take(slot, None if mine is None or holders is None else mine + holders)
        for activation, count in other.members.items():
            self.members[activation] = self.members.get(activation, 0) + count
        for activation in other.interested:
            self.concern(activation)
        if other.pressed:
            self.pressed = {**other.pressed, **(self.pressed or {})}
        if other.eliminated:
            self.eliminated = other.eliminated | (self.eliminated or set())
        if other.answers:
            self.answers = {**other.answers, **self.answers}
        other.members = {}
        other.taken = other.interested = other.answers = NOTHING

    def __repr__(self) -> str:
        return f"group {self.id}"
