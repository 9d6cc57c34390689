"""A refusal: the reasons for which a ready activation waits (law L15)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ravestate.engine.activation import NEVER, Activation

if TYPE_CHECKING:
    from ravestate.engine.group import Group
    from ravestate.policy.model import Clause

RULE: Final = 0
OUTSIDE: Final = 1
SEEN: Final = 2
"""Kinds of *hope*. A hope is a thing outside an activation's groups whose change may lift the activation's refusal.

`RULE`: the activations of a rule in other groups. `OUTSIDE`: the live rules of other groups that may raise a signal.
`SEEN`: the next spike of a signal, at which a detached need looks.
"""


class Refusal:
    """The reasons for which an activation must wait. If `names` is empty, the activation has consent.

    Attributes:
        names: Key: the name of a rule that the activation waits for; value: the best of that rule's clauses that are
            rivals.
        blockers: The live activations on whose progress the refusal depends. `explain` does not show them.
        sure: For each rival that work in progress will make ready or rule out: the activations that do this work.
        taken: Whether a run has taken one of the activation's slots.
        in_doubt: Whether a rival may never be ready, so that only the end of its patience ends the wait.
        hopes: The hopes of the activation → a count for each (`Horizon.hopes`).
        interests: The groups whose changes may lift the refusal.
        leader: The activation that this one follows (``leaders.py``), or None.
        told: The names of rules in the trace's record of this wait; empty without a tracer.
        recheck: The earliest time (seconds) at which the refusal may end without any event: because a rule recovers,
            because a spike becomes too old, or because the patience of a rival without an activation ends.
    """

    __slots__ = ("blockers", "sure", "hopes", "interests", "leader", "names", "in_doubt", "recheck", "taken", "told")

    def __init__(self) -> None:
        self.interests: dict[Group, None] = {}
        self.hopes: dict[tuple[int, int], int] = {}
        self.names: dict[str, Clause] = {}
        self.blockers: dict[Activation, None] = {}
        self.sure: list[tuple[Activation, ...]] = []
        self.leader: Activation | None = None
        self.taken = False
        self.in_doubt = False
        self.recheck = NEVER
        self.told: tuple[str, ...] = ()

    def name(self, rival: Clause) -> None:
        """Record that the activation waits for a rival."""
        known = self.names.get(rival.rule.name)
        if known is None or known.base < rival.base:
            self.names[rival.rule.name] = rival

    @property
    def all_names(self) -> dict[str, Clause]:
        """The names of the rules that the activation waits for, and those that its leader waits for."""
        leader = self.leader
        if leader is None or leader.refusal is None:
            return self.names
        return {**leader.refusal.all_names, **self.names}

    @property
    def bounded(self) -> bool:
        """Whether the wait is sure to end: when a run frees its slot, or when a rival's patience ends."""
        return self.taken or self.in_doubt

    def __bool__(self) -> bool:
        return bool(self.names)


CONSENT: Final = Refusal()
"""The empty refusal: the activation has consent."""
