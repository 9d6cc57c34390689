"""A causal group: spikes with a common cause, and what has been decided about them (L11, L15)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation

__all__ = ["Group"]


class Group:
    """Which slots are taken in it, and which activations have a stake in it.

    Attributes:
        taken: For each slot taken here: the activation that runs, or None once it has finished.
        members: The activations that hold non-detached spikes of it, oldest first; with how many.
        interested: The waiting activations to be asked again when something ends in it.
        pressed: Stand-by rivals (numbers of clauses) under pressure: until when they have patience (seconds).
        eliminated: Stand-by rivals whose patience has run out.
    """

    __slots__ = ("eliminated", "id", "interested", "into", "members", "pressed", "taken")

    def __init__(self, id: int) -> None:
        self.id = id
        self.into: Group | None = None  # the group that this one has merged into
        self.taken: dict[int, Activation | None] = {}
        self.members: dict[Activation, int] = {}
        self.interested: dict[Activation, None] = {}
        self.pressed: dict[int, float] | None = None
        self.eliminated: set[int] | None = None

    def root(self) -> Group:
        """The group that this one belongs to now."""
        group = self
        while group.into is not None:
            group = group.into
        return group

    def eliminate(self, clause: int) -> None:
        """The patience of a stand-by rival has run out."""
        if self.eliminated is None:
            self.eliminated = set()
        self.eliminated.add(clause)

    def absorb(self, other: Group) -> None:
        """Make `other` part of this group. What is finished in either is finished in both."""
        other.into = self
        for slot, holder in other.taken.items():
            if slot not in self.taken or holder is None:
                self.taken[slot] = holder
        for activation, count in other.members.items():
            self.members[activation] = self.members.get(activation, 0) + count
        self.interested.update(other.interested)
        if other.pressed:
            self.pressed = {**other.pressed, **(self.pressed or {})}
        if other.eliminated:
            self.eliminated = other.eliminated | (self.eliminated or set())
        other.members = {}
        other.interested = {}
        other.taken = {}

    def __repr__(self) -> str:
        return f"group {self.id}"
