"""A refusal: the reasons for which a ready activation waits (L15)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ravestate.engine.activation import NEVER, Activation

if TYPE_CHECKING:
    from ravestate.engine.group import Group
    from ravestate.policy.model import Clause

RULE: Final = 0
OUTSIDE: Final = 1
SEEN: Final = 2
"""Kinds of hope: an activation in another group; a live rule that may raise a signal; a new spike to look at."""


class Refusal:
    """The reasons for which an activation must wait. If `names` is empty, the activation has consent.

    Attributes:
        names: Name of a rule that the activation waits for → the best of its clauses that compete.
        blockers: The live activations on whose progress the refusal depends. `explain` does not show them.
        firm: For each rival that work in progress will make ready or rule out: the activations at work.
        taken: Whether a slot is taken.
        pressed: Whether a rival may never be ready, so that only its patience ends the wait.
        hopes: Things outside its groups on which the refusal depends (`Horizon.hopes`).
        interests: The groups whose changes may lift the refusal.
        leader: The activation that speaks for this one (``leaders.py``), or None.
        told: The names that the trace has told, if there is a tracer.
        recheck: The earliest time at which recovering utilities, the patience of a rival without an activation, or the
            age of a spike may lift it (seconds).
    """

    __slots__ = ("blockers", "firm", "hopes", "interests", "leader", "names", "pressed", "recheck", "taken", "told")

    def __init__(self) -> None:
        self.interests: dict[Group, None] = {}
        self.hopes: dict[tuple[int, int], int] = {}
        self.names: dict[str, Clause] = {}
        self.blockers: dict[Activation, None] = {}
        self.firm: list[tuple[Activation, ...]] = []
        self.leader: Activation | None = None
        self.taken = False
        self.pressed = False
        self.recheck = NEVER
        self.told: tuple[str, ...] = ()

    def name(self, rival: Clause) -> None:
        """Note that the activation waits for a clause."""
        known = self.names.get(rival.rule.name)
        if known is None or known.base < rival.base:
            self.names[rival.rule.name] = rival

    @property
    def all_names(self) -> dict[str, Clause]:
        """The names, with those for which the leader waits."""
        leader = self.leader
        if leader is None or leader.refusal is None:
            return self.names
        return {**leader.refusal.all_names, **self.names}

    @property
    def bounded(self) -> bool:
        """Whether the wait is for a taken slot, or for a rival whose patience ends the wait."""
        return self.taken or self.pressed

    def __bool__(self) -> bool:
        return bool(self.names)


CONSENT: Final = Refusal()
"""The empty refusal of an activation that has no rival."""
