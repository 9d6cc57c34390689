"""The state of an engine: its tables, and the questions that they answer. This file makes no decision.

An event finds its spikes and activations without a search: live spikes by signal, activations by rule, and incomplete
activations by the constraint for which they lack a spike. So the cost of an event does not grow with the number of
rules.

The tables use three words. A *need* is one constraint of a clause. A *half* keeps the first spikes of clauses with two
needs, without activations, until a second spike comes (``halves.py``). A *bench* is a table of first spikes that wait
for the same second spike, or share it already (``benches.py``).

The parts of the engine share one state. Only `State.adopt` and these files change the state's tables:

- `active`: ``holdings.py``
- `lacking`: ``holdings.py``, ``matching.py`` and ``halves.py``; `gated`: ``holdings.py`` and ``slots.py``
- `live`: ``matching.py`` and ``entries.py``; `dropped`: ``matching.py``; `busy`: ``holdings.py`` and ``entries.py``
- `halves`, `pools`, `seats`, `benches`: ``entries.py`` and ``benches.py``
- `rows`: ``halves.py`` and ``entries.py``
- `headless`: ``holdings.py`` and ``benches.py``
- `patience_ends`: ``consent.py`` and ``entries.py``; `alternatives`: ``conflict_sets.py`` and ``holdings.py``
- `waiting`, `hoping`, `hope_counts`: ``waits.py``; `refused`, `stuck`: ``waits.py`` and ``agenda.py``
- `running`, `ran`, `watches`: ``runs.py``; `watched_by`: ``runs.py`` and ``holdings.py``; `retired`: ``parts.py``
- `values`, `unseen`: ``slots.py``; a read of a slot changes them, too (`Memory.read`)

Any part may add to the tables of the work that is left: `asking`, `dirty`, `stirred`, `free`, `errors`, `out`.
`Waits.wake` empties the first three, ``agenda.py`` empties `free`, and ``parts.py`` empties `errors` and `out`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from typing import Any

from ravestate.declare.condition import Holds
from ravestate.declare.core import RuleFailure
from ravestate.engine.activation import Activation
from ravestate.engine.bench import Bench
from ravestate.engine.deadlines import Deadlines
from ravestate.engine.effects import Effect, Failed
from ravestate.engine.free import Free
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.lineage import Lineage
from ravestate.engine.loops import Loops
from ravestate.engine.memory import Memory
from ravestate.engine.row import Row
from ravestate.engine.spike import Spike
from ravestate.engine.standing import Standing
from ravestate.engine.stuck import Stuck
from ravestate.engine.trace import Tracer
from ravestate.engine.watch import Watch
from ravestate.policy.model import Clause, Half, Need, RulePlan, SlotPlan
from ravestate.policy.policy import Policy


class State(Memory):
    """The memory, live spikes and activations of an engine, and the work that is left to do.

    An engine at rest has only a `Memory`. When the engine begins to work, a state takes over this memory (`begin`).

    Args:
        policy: A policy from ``rs.compile``.
    """

    __slots__ = (
        "active",
        "activity",
        "acts",
        "added",
        "alternatives",
        "asking",
        "benches",
        "busy",
        "causes",
        "deadlines",
        "dirty",
        "errors",
        "faults",
        "free",
        "gated",
        "halves",
        "headless",
        "hope_counts",
        "hoping",
        "lacking",
        "live",
        "loops",
        "out",
        "pools",
        "patience_ends",
        "pressure",
        "refused",
        "reordered",
        "rows",
        "running",
        "seats",
        "signal_of",
        "slot_of",
        "standing",
        "stirred",
        "stuck",
        "tracer",
        "waiting",
        "watched_by",
        "watches",
    )

    def __init__(self, policy: Policy) -> None:
        super().__init__(policy, 0.0, False)
        self.signal_of = policy.signal_of
        self.slot_of = policy.slot_of
        self.causes = policy.causes
        self.activity = policy.slot_of["core:activity"]
        self.pressure = policy.slot_of["core:pressure"]
        self.tracer: Tracer | None = None
        self.deadlines = Deadlines(self)
        # Most engines need only some of these tables. A table that begins as `NOTHING` is made at its first entry.
        self.live: dict[int, dict[Spike, None]] = {}
        """Index of a signal → its live spikes, oldest first."""
        self.active: dict[int, dict[Activation, None]] = {}
        """Index of a rule → its activations that hold a spike or run."""
        self.lacking: dict[Need, dict[Activation, None]] = {}
        """Need → the activations that hold a spike, but lack one for this need."""
        self.halves: dict[Half, OrderedDict[Spike, int]] = NOTHING
        """Half → the spikes that it holds without an activation, oldest first (``halves.py``). Spikes on a bench that
        already share a second spike are left out. Each spike has a number *n*: its activations, if the engine makes
        them, get the numbers from *n* + 1 on."""
        self.rows: dict[Half, Row] = NOTHING
        """Half whose spikes are slow to search → an index of these spikes (``row.py``)."""
        self.pools: dict[Half, Bench] = NOTHING
        """Half with benches (``benches.py``) → its bench whose spikes still lack a second spike; these spikes are in
        `halves`."""
        self.benches: dict[Spike, dict[Half, Bench]] = NOTHING
        """Counterpart (a second spike) → half → the bench of this half whose spikes share the counterpart."""
        self.seats: dict[Half, dict[Spike, Bench]] = NOTHING
        """Half with benches → each spike that the half holds → the bench of the spike."""
        self.headless: dict[Spike, None] = NOTHING
        """The counterparts of benches that may need a new head (the activation of the bench's oldest pair)."""
        self.patience_ends: dict[Spike, dict[Half, list[tuple[int, float]]]] = NOTHING
        """Spike → half that holds the spike → pairs of a count and a time (seconds). A count n says that the
        first n clauses of the half, the best first, are under pressure. Earlier pairs have smaller counts. The time is
        the end of the patience of those clauses that no earlier pair includes (law L16)."""
        self.gated: dict[Activation, None] = NOTHING
        """Activations that hold all their spikes, all old enough, but have a slot predicate that is false."""
        self.free = Free()
        """The ready activations that need no consent."""
        self.asking: dict[Activation, None] = {}
        """The ready or waiting activations that are about to ask for consent."""
        self.reordered = False
        """Whether the order of the asking activations may have changed: groups have merged, or a cooldown has begun."""
        self.waiting: dict[Activation, None] = {}
        """Ready activations that were refused consent."""
        self.refused: dict[Activation, None] = {}
        """The activations with which the next search for a *stalemate* begins: those that were refused, or whose waits
        may have changed, since the last search. In a stalemate, activations wait only for each other."""
        self.stuck: Stuck | None = None
        """The activations that were found to wait only for each other (``stalemate.py``); None before the first of
        them."""
        self.dirty: dict[Group, None] = {}
        """The groups with a change that may lift a refusal: e.g. a run or a patience has ended, or a member has joined,
        changed or left. The activations whose refusals depend on these groups ask again (`Waits.wake`)."""
        self.hoping: dict[tuple[int, int], dict[Activation, None]] = NOTHING
        """Hope → the waiting activations that have it. A hope is something outside an activation's groups that may lift
        the activation's refusal (``activation.py``)."""
        self.hope_counts: dict[tuple[int, int], int] = NOTHING
        """Hope → the greatest of the counts that the refusals of the waiting activations have for this hope
        (`Horizon.hopes`)."""
        self.stirred: dict[tuple[int, int], None] = NOTHING
        """The hopes that have changed. The activations that have these hopes ask again (`Waits.wake`)."""
        self.alternatives: dict[Activation, tuple[tuple[Clause, ...], int, int]] = NOTHING
        """Key: the present activation of a conflict set (clauses that compete for a spike, ``conflict_sets.py``).
        Value: the clauses of the set, how many of them have had an activation, and a number *n*. Their activations get
        the numbers from *n* + 1 on."""
        self.running: dict[int, Activation] = {}
        """Number of a run → the activation whose function runs."""
        self.standing = Standing(self.ran)
        self.watches: dict[Clause, dict[Activation, Watch]] = NOTHING
        """Clause of an `until` condition → run → the run's `Watch` for that clause."""
        self.watched_by: dict[Spike, dict[Watch, None]] = NOTHING
        """Spike → the watches that hold it."""
        self.out: list[Effect] = []
        """The effects that the runtime has not taken yet."""
        self.acts = False
        """Whether an effect in `out` starts or cancels a run."""
        self.errors: tuple[tuple[RuleFailure, Lineage | None, Any], ...] = ()
        """The failures that ``core:error`` has not reported yet, each with its lineage (the rules that led
        to it), and the origin of the failed run."""
        self.faults: dict[int, tuple[Clause, Any, Exception]] = NOTHING
        """Key: the `id` of a predicate whose exception is not reported yet. Value: the first declared clause with the
        predicate, the predicate, and the exception."""
        self.loops = Loops(self)
        self.busy = 0
        """How many activations, and spikes in halves, count for ``core:activity``."""
        self.added = 0
        """The number of the newest spike at the time when a rule was last added."""

    def begin(self, memory: Memory) -> None:
        """Take over the memory of an engine that begins to work."""
        self.take(memory)
        self.standing.ran = memory.ran

    def end(self, memory: Memory) -> None:
        """Give the memory back to an engine that comes to rest, and keep nothing of it."""
        memory.take(self)
        self.values = self.unseen = self.ran = self.dropped = self.watched = self.standing.ran = NOTHING
        self.added = 0

    @property
    def at_rest(self) -> bool:
        """Whether nothing is live or due, the runtime has taken all effects, and no tracer listens."""
        if self.live or self.active or self.out or self.errors or self.faults or self.tracer is not None:
            return False
        if self.values.get(self.activity.index) or self.values.get(self.pressure.index):
            return False  # code outside the rules has set a built-in flag, which the engine must settle
        return self.deadlines.next() is None

    def adopt(self, policy: Policy) -> None:
        """Replace the policy by a policy that begins with the same rules in the same order, and has more rules."""
        self.policy = policy
        self.added = self.spikes
        self.signal_of = policy.signal_of
        self.slot_of = policy.slot_of
        self.causes = policy.causes
        self.activity = policy.slot_of["core:activity"]
        self.pressure = policy.slot_of["core:pressure"]
        clauses, signals = policy.clause_plans, policy.signal_plans
        for activations in self.active.values():
            for activation in activations:
                activation.clause = clauses[activation.clause.index]
                for group in activation.firm_groups():
                    group.roster = None
        tables: list[Iterable[Spike]] = [*self.live.values(), self.watched_by]
        for spikes in tables:
            for spike in spikes:
                spike.signal = signals[spike.signal.index]
        self.lacking = {clauses[n.clause.index].needs[n.index]: lacking for n, lacking in self.lacking.items()}
        self.watches = {clauses[clause.index]: watches for clause, watches in self.watches.items()}
        for watches in self.watches.values():
            for watch in watches.values():
                watch.clause = clauses[watch.clause.index]

    # ------------------------------------------------------------------------------------ spikes

    def is_live(self, spike: Spike) -> bool:
        """Return whether a spike is live: not withdrawn, and something holds it or detached needs may look at it."""
        live = self.live.get(spike.signal.index)
        return live is not None and spike in live

    def newest(self, need: Need) -> Spike | None:
        """Return the newest live spike that fits a need; None if no spike fits."""
        for spike in reversed(self.live.get(need.signal.index, {})):
            if self.fits(need, spike):
                return spike
        return None

    def fits(self, need: Need, spike: Spike) -> bool:
        """Return whether a live spike may meet a need, now or when it is old enough.

        The spike must not be too old, its payload must fit, and the need's rule must still be allowed to take it.
        """
        rule = need.clause.rule
        if spike.born + need.max_age <= self.now and (need.max_age or spike.born < self.now):
            return False
        if not need.detached:
            if spike.refused is not None and rule.index in spike.refused:
                return False
            if spike.group.root().finished(rule.slots):
                return False
            if need.clause.cyclic and spike.descends_from(rule.index):
                return False
        return not need.predicates or self.accepts(need, spike.payload)

    def halves_of(self, spike: Spike) -> Sequence[Half]:
        """Return the halves that hold a spike."""
        return [half for half in spike.signal.halves if self.entries(half, spike)] if spike.in_halves else ()

    def entries(self, half: Half, spike: Spike) -> OrderedDict[Spike, int] | None:
        """Return the table in which a half holds a spike; None if the half does not hold the spike."""
        if half.sole:
            bench = self.bench_of(half, spike)
            return None if bench is None else bench.spikes
        held = self.halves.get(half)
        return held if held is not None and spike in held else None

    def bench_of(self, half: Half, spike: Spike) -> Bench | None:
        """Return the bench on which a half holds a spike; None if there is no such bench."""
        seats = self.seats.get(half)
        return None if seats is None else seats.get(spike)

    def keeps(self, need: Need, spike: Spike) -> bool:
        """Return whether the half of `need` holds a spike for the need's clause."""
        held = self.entries(need.half, spike) if need.half is not None else None
        return held is not None and not (spike.parted and need.clause.index in spike.parted)

    def entry_number(self, need: Need, spike: Spike) -> int:
        """Return the number that the activation of the need's clause gets if the half makes activations of a spike."""
        half = need.half
        assert half is not None
        held = self.entries(half, spike)
        assert held is not None
        return held[spike] + half.places[need.clause.rule.index] + 1

    def stand_in(self, need: Need, spike: Spike) -> Activation:
        """Return an activation like the one that the need's half would make of a spike. No table of the engine contains
        it."""
        activation = Activation(self.entry_number(need, spike), need.clause)
        activation.put(need, spike)
        activation.missing &= ~need.bit
        until = self.entry_patience(need, spike)
        if until is not None:
            activation.patience_ends = {spike.group.root(): until}
        return activation

    def entry_patience(self, need: Need, spike: Spike) -> float | None:
        """Return when the patience of the need's clause ends (seconds), if a half holds the spike for this clause.

        Return None if the clause is not under pressure.
        """
        half = need.half
        if half is None or spike not in self.patience_ends:
            return None
        rank = half.rank[need.clause.index]
        for count, until in self.patience_ends[spike].get(half, ()):
            if rank < count:
                return until
        return None

    # ------------------------------------------------------------------------------------ slots and predicates

    def is_open(self, clause: Clause) -> bool:
        """Return whether the clause's slot predicates are true.

        A predicate that raises an exception counts as false, and is reported.
        """
        for slot, guard in clause.guards:
            if not self.test(guard.predicate, self.read(slot.index), clause):
                return False
        return True

    def opens(self, slot: SlotPlan, guard: Holds) -> bool:
        """Return whether a slot predicate is true. An exception in the predicate counts as false, without a report."""
        try:
            return bool(guard.predicate(self.read(slot.index)))
        except Exception:  # the designer's predicate may raise anything
            return False

    def test(self, predicate: Any, value: Any, clause: Clause) -> bool:
        """Return the result of a clause's predicate. An exception counts as false, and is reported once."""
        try:
            return bool(predicate(value))
        except Exception as exception:  # a predicate is the designer's code, which may raise anything
            if id(predicate) not in self.blamed:
                self._note_fault(clause, predicate, exception)
            return False

    def _note_fault(self, clause: Clause, predicate: Any, exception: Exception) -> None:
        """Keep a predicate's exception for `report_faults`. If several clauses have the predicate, keep the clause
        declared first."""
        if self.faults is NOTHING:
            self.faults = {}
        known = self.faults.get(id(predicate))
        if known is None or clause.index < known[0].index:
            self.faults.pop(
                id(predicate), None
            )  # the faults of one clause stay in the order in which its predicates were called
            self.faults[id(predicate)] = clause, predicate, exception

    def accepts(self, need: Need, payload: Any) -> bool:
        """Return whether all predicates of a need accept a payload. After one that refuses it, no more are called."""
        for predicate in need.predicates:
            if not self.test(predicate, payload, need.clause):
                return False
        return True

    def report_faults(self) -> None:
        """Report the predicates that raised an exception, in declaration order (L5), not in order of calls."""
        faults, self.faults = self.faults, NOTHING
        for clause, predicate, exception in sorted(faults.values(), key=_declared):
            self.blamed |= {id(predicate)}
            self.fail(clause.rule, exception, signal=True)

    def fail(
        self,
        rule: RulePlan,
        exception: BaseException,
        *,
        signal: bool,
        lineage: Lineage | None = None,
        origin: Any = None,
    ) -> None:
        """Report a failure of a rule to the runtime; with `signal`, ``core:error`` occurs next."""
        self.out.append(Failed(rule.name, exception))
        if signal:
            self.errors = (*self.errors, (RuleFailure(rule.name, exception), lineage, origin))

    # ------------------------------------------------------------------------------------ utility

    def effective(self, clause: Clause) -> float:
        """Return the effective utility of a clause now (L9): utility x weight x recovery, in nats."""
        self.standing.now = self.now
        return self.standing.effective(clause)

    def lead(self, one: Clause, other: Clause) -> float:
        """Return by how many nats a clause is ahead of another now (`Standing.lead`)."""
        self.standing.now = self.now
        return self.standing.lead(one, other)

    def order(self, activation: Activation) -> tuple[float, int, int]:
        """Return the sort key of a ready activation: greatest effective utility, then first declared, then oldest."""
        return (-self.effective(activation.clause), activation.clause.index, activation.id)


def _declared(fault: tuple[Clause, Any, Exception]) -> int:
    return fault[0].index
