"""The life of an activation (laws L12, L14, L17, L18).

An activation is a clause plus the spikes that it has acquired. Each constraint of the clause is a *need*: one spike
meets it. With consent, the activation becomes a run of the rule. Every clause also has an activation on stand-by, which
holds no spike yet. No object represents a stand-by: the engine creates an object when the first spike comes, or later.

- `GATHERING`: the activation lacks a spike, a spike is too young, or a predicate on a slot is false.
- `READY`: the activation holds all its spikes, all are old enough, and its slot predicates are true. It asks for
  consent or, if it needs none, starts.
- `WAITING`: a group refused consent; the activation asks again when something changes.
- `RUNNING`: the rule's function runs.
- `CANCELLING`: the engine has cancelled the function, which is cleaning up.
- `ENDED`: the activation no longer holds anything.

A step that is not in the table of transitions is a bug in the engine.
"""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any, Final

from ravestate.engine.group import NOTHING
from ravestate.errors import EngineError

if TYPE_CHECKING:
    from ravestate.engine.group import Group
    from ravestate.engine.lineage import Lineage
    from ravestate.engine.spike import Spike
    from ravestate.policy.model import Clause, Need

NEVER: Final = float("inf")
"""A time that never comes."""


class State(enum.IntEnum):
    """The state of an activation."""

    GATHERING = 0
    READY = 1
    WAITING = 2
    RUNNING = 3
    CANCELLING = 4
    ENDED = 5


class Step(enum.IntEnum):
    """A step in the life of an activation."""

    COMPLETE = 0  # the activation holds all its spikes, they are old enough, and its slot predicates are true (L14)
    LOSE = 1  # the activation gave a spike up, or a slot predicate became false
    REFUSE = 2  # a group refused consent (L15)
    GRANT = 3  # every group consented (L17)
    CANCEL = 4  # the run was interrupted, timed out, or wiped (L18, L20, L21)
    END = 5  # the run finished, or the activation gave up all its spikes


_G, _R, _W, _X, _C, _E = State  # short names, to make the table readable
TRANSITIONS: dict[tuple[State, Step], State] = {
    (_G, Step.COMPLETE): _R,
    (_G, Step.LOSE): _G,
    (_G, Step.END): _E,
    (_R, Step.LOSE): _G,
    (_R, Step.REFUSE): _W,
    (_R, Step.GRANT): _X,
    (_R, Step.END): _E,
    (_W, Step.LOSE): _G,
    (_W, Step.REFUSE): _W,
    (_W, Step.GRANT): _X,
    (_W, Step.END): _E,
    (_X, Step.CANCEL): _C,
    (_X, Step.END): _E,
    (_C, Step.END): _E,
}

_TABLE: Final = [[int(TRANSITIONS.get((state, step), -1)) for step in Step] for state in State]

# The same states and steps as plain integers, which are faster than members of an enumeration.
GATHERING: Final = 0
READY: Final = 1
WAITING: Final = 2
RUNNING: Final = 3
ENDED: Final = 5
NAMES: Final = tuple(state.name.lower() for state in State)
"""The names of the states, in lower case; the integer of a state is the index of its name."""
COMPLETE: Final = 0
LOSE: Final = 1
REFUSE: Final = 2
GRANT: Final = 3
CANCEL: Final = 4
END: Final = 5


class Activation:
    """A clause plus the spikes that it has acquired.

    Attributes:
        id: A number that grows with each new activation. It may depend on whether there is a tracer, so only the trace,
            snapshots and explanations show it.
        number: The number that events and effects use for its run; 0 until it runs. Runs are numbered in the order of
            their start, so a tracer cannot change the number (L24, L25).
        state: The `State`, as an integer.
        missing: The needs of the clause that no spike meets yet, as bits.
        ripens: The time (seconds) at which all its spikes will be old enough; `NEVER` unless a spike is too young.
        newest: The number of the newest spike that the activation held when it joined the queue of ``free.py``.
        place: Its place in the queue of ``free.py``; None if the activation is not in the queue, or is in the
            queue's `batch`.
        patience_ends: Key: a group in which other activations wait for this one; value: the time at which this
            activation's patience ends in that group (seconds; L16).
        refusal: The reasons for which it waits; None unless it waits.
        stands_on: The spikes that the run holds for non-detached needs. They are the parents of the spikes that the run
            raises, unless its rule is detached.
        origin: The origin of the run (`Spike.origin`).
        groups: The groups in which the run took its slots when it began. They may have merged since.
        wrote: Whether the run has written a slot.
        deadline: The time at which the run times out (seconds); `NEVER` without a timeout.
        told: The reason for which the engine cancelled the run; empty if the engine did not cancel it.
        lineage: The rules that led to the run within its instant, including its own rule; None if the instant had few
            runs (L23).
    """

    __slots__ = (
        "_only",
        "_several",
        "clause",
        "deadline",
        "groups",
        "id",
        "lineage",
        "missing",
        "newest",
        "number",
        "origin",
        "place",
        "patience_ends",
        "refusal",
        "ripens",
        "stands_on",
        "state",
        "told",
        "wrote",
    )

    def __init__(self, id: int, clause: Clause) -> None:
        self.id = id
        self.number = 0
        self.clause = clause
        self.state: int = GATHERING
        # Most clauses have one need, and thousands of activations may wait: a sequence in each would slow the garbage
        # collector.
        self._only: Spike | None = None
        self._several: tuple[Spike | None, ...] = (None,) * len(clause.needs) if len(clause.needs) > 1 else ()
        self.missing = clause.all_bits
        self.ripens = NEVER
        self.newest = 0
        self.place: Place | None = None
        self.patience_ends: dict[Group, float] = NOTHING  # replaced on first use
        self.refusal: Refusal | None = None
        self.stands_on: tuple[Spike, ...] = ()
        self.origin: Any = None
        self.groups: tuple[Group, ...] = ()
        self.wrote = False
        self.deadline = NEVER
        self.told = ""
        self.lineage: Lineage | None = None

    @property
    def spikes(self) -> tuple[Spike | None, ...]:
        """For each need of the clause, the spike that meets it; None if there is none yet."""
        return self._several or (self._only,)

    def spike(self, need: Need) -> Spike | None:
        """Return the spike that meets one of the clause's needs; None if there is none yet."""
        return self._several[need.index] if self._several else self._only

    def holds(self, spike: Spike) -> bool:
        """Return whether the activation holds a spike."""
        return spike in self._several if self._several else spike is self._only

    def put(self, need: Need, spike: Spike | None) -> None:
        """Set the spike that meets one of the clause's needs, or None if no spike meets it any longer."""
        if self._several:
            spikes = list(self._several)
            spikes[need.index] = spike
            self._several = tuple(spikes)
        else:
            self._only = spike

    def step(self, step: int) -> None:
        """Take a `Step`: change the state as the table of transitions says.

        Raises:
            EngineError: The table has no transition for this step from the present state.
        """
        state = _TABLE[self.state][step]
        if state < 0:
            name, place = Step(step).name, State(self.state).name
            raise EngineError(f"activation {self.id} of {self.clause}: {name} in state {place}")
        self.state = state

    def held(self, bits: int) -> Spike | None:
        """Return a spike that the activation holds for one of the needs in `bits`, or None."""
        for need in self.clause.needs:
            if need.bit & bits and not need.bit & self.missing:
                return self.spike(need)
        return None

    def firm_groups(self) -> list[Group]:
        """Return the present causal groups of the activation's spikes for non-detached needs, each group once."""
        if not self._several and self.clause.firm_bits:
            only = self._only
            return [] if only is None else [only.group if only.group.into is None else only.group.root()]
        found: list[Group] = []
        for need in self.clause.needs:
            spike = self.spike(need)
            if spike is not None and not need.detached:
                group = spike.group if spike.group.into is None else spike.group.root()
                if group not in found:
                    found.append(group)
        return found

    def firm_spikes(self) -> tuple[Spike, ...]:
        """Return the activation's spikes for non-detached needs: the parents of the spikes that its run raises."""
        if self.clause.firm_bits == self.clause.all_bits and not self.missing:
            return self.spikes  # type: ignore[return-value]  # nothing is missing
        return tuple(
            spike
            for spike, need in zip(self.spikes, self.clause.needs, strict=True)
            if spike is not None and not need.detached
        )

    def __repr__(self) -> str:
        return f"{self.clause}@{self.id}"


Place = tuple[int, int, int, Activation]
"""The place of an activation in the queue of ``free.py``."""


def by_age(activation: Activation) -> int:
    """Return the sort key for activations, the oldest first."""
    return activation.id


RULE: Final = 0
OUTSIDE: Final = 1
SEEN: Final = 2
"""Kinds of *hope*. A hope is a thing outside an activation's groups whose change may lift the activation's refusal.

`RULE`: the activations of a rule in other groups. `OUTSIDE`: the live rules of other groups that may raise a signal.
`SEEN`: the next spike of a signal that a detached need looks at.
"""


class Refusal:
    """The reasons for which an activation must wait. If `names` is empty, the activation has consent.

    Attributes:
        names: Key: the name of a rule that the activation waits for; value: the best of the rule's clauses that the
            activation waits for. Such a clause is a rival, or its run has taken a slot.
        blockers: The live activations on whose progress the refusal depends. `explain` does not show them.
        sure: An entry for each rival whose readiness depends only on work in progress: the activations that do this
            work.
        taken: Whether a run has taken one of the activation's slots.
        in_doubt: Whether a rival may never become ready. The wait for this rival ends at the latest with its patience.
        hopes: Key: a hope of the activation; value: the hope's count (`Horizon.hopes`).
        interests: The groups whose changes may lift the refusal.
        leader: The better activation for which this one waits without examining other rivals (``leaders.py``), or None.
        told: The names of rules in the trace's record of this wait; empty without a tracer.
        recheck: The earliest time (seconds) at which the refusal may end without any event: because a rule recovers
            from its cooldown, because a spike becomes too old, or because the patience of a rival without an activation
            ends.
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
        """Record that the activation waits for a clause: a rival, or the clause of a run that has taken a slot."""
        known = self.names.get(rival.rule.name)
        if known is None or known.base < rival.base:
            self.names[rival.rule.name] = rival

    @property
    def all_names(self) -> dict[str, Clause]:
        """The entries of `names`, and those of the leader: the rules that the activation waits for, also indirectly."""
        leader = self.leader
        if leader is None or leader.refusal is None:
            return self.names
        return {**leader.refusal.all_names, **self.names}

    @property
    def bounded(self) -> bool:
        """Whether the wait is sure to end: when the run that took a slot ends, or when a rival's patience ends."""
        return self.taken or self.in_doubt

    def __bool__(self) -> bool:
        return bool(self.names)


CONSENT: Final = Refusal()
"""The empty refusal: the activation has consent."""
