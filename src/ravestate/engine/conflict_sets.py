"""Conflict sets: clauses that the same spike makes ready, although only one of them can run.

A thousand rules that hear the same signal and write the same slot would need a thousand activations. One would run, and
the rest would lose the spike. So only the best clause (with the greatest utility x weight) gets an activation. The
other clauses form the activation's queue of alternatives. If the activation's run resigns, or fails before it writes,
the next clause gets an activation.

If there is a tracer, or when a rule retires or is added, the queue *unfolds* into ordinary activations. It also
unfolds, for example, if a rival's utility may lie between the utilities of the clauses (`Consent.is_contested`). The
number of each activation is fixed from the start, and no signal that an alternative raises can help a rival
(`find_conflict_sets`). So it does not matter when a queue unfolds. An explanation unfolds nothing.
"""

from __future__ import annotations

from ravestate.engine.activation import Activation
from ravestate.engine.group import NOTHING
from ravestate.engine.holdings import Holdings
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.policy.model import Clause, SignalPlan


class ConflictSets:
    """The part of the engine that keeps the queues of alternatives."""

    __slots__ = ("holdings", "state")

    def __init__(self, state: State, holdings: Holdings) -> None:
        self.state = state
        self.holdings = holdings

    def offer(self, signal: SignalPlan, spike: Spike) -> None:
        """Offer a spike to the conflict sets of its signal."""
        state = self.state
        for clauses in signal.conflict_sets:
            if spike.group.finished(clauses[0].rule.slots):
                for clause in clauses if state.tracer is not None else ():
                    self.holdings.pass_by(clause, spike, "consumed")
                continue  # the spike is consumed for all clauses of the set
            clauses = tuple([clause for clause in clauses if self._enters(clause, spike)])
            if not clauses:
                continue
            base = state.activations
            state.activations += len(clauses)
            self._next(clauses, 0, base, spike)
        if state.tracer is not None:
            self.unfold_all()

    def substitute(self, activation: Activation) -> None:
        """Create the activation of the next alternative after a run that has resigned, or failed before it wrote."""
        queued = self.state.alternatives.pop(activation, None)
        spike = activation.spike(activation.clause.needs[0])
        if queued is not None and spike is not None and not spike.group.root().finished(activation.clause.rule.slots):
            clauses, made, base = queued
            refused = spike.refused or ()
            while made < len(clauses) and clauses[made].rule.index in refused:
                made += 1  # this clause's rule gave the spike up for good
            if made < len(clauses):
                self._next(clauses, made, base, spike)

    def unfold(self, activation: Activation) -> None:
        """Create the activations of all alternatives in one activation's queue."""
        clauses, made, base = self.state.alternatives.pop(activation)
        spike = activation.spike(activation.clause.needs[0])
        assert spike is not None  # the activation is ready or runs, so it holds a spike
        if spike.group.root().finished(activation.clause.rule.slots):
            return  # the spike's group has merged with a group in which the slots are consumed
        for position in range(made, len(clauses)):
            if spike.refused is None or clauses[position].rule.index not in spike.refused:
                self._activate(clauses[position], base + position + 1, spike)

    def unfold_all(self) -> None:
        """Create the activations of the alternatives in all queues."""
        for activation in list(self.state.alternatives):
            self.unfold(activation)

    def _enters(self, clause: Clause, spike: Spike) -> bool:
        """Return whether a clause takes a spike: its rule has not retired, and its predicates accept the payload."""
        if self.state.retired and clause.rule.index in self.state.retired:
            return False
        need = clause.needs[0]
        if need.predicates and not self.state.accepts(need, spike.payload):
            self.holdings.pass_by(clause, spike, "payload")
            return False
        return True

    def _next(self, clauses: tuple[Clause, ...], position: int, base: int, spike: Spike) -> None:
        """Create the activation of the clause at a position; the later clauses become its alternatives."""
        activation = self._activate(clauses[position], base + position + 1, spike)
        if position + 1 < len(clauses):
            if self.state.alternatives is NOTHING:
                self.state.alternatives = {}
            self.state.alternatives[activation] = (clauses, position + 1, base)

    def _activate(self, clause: Clause, number: int, spike: Spike) -> Activation:
        activation = self.holdings.new_activation(clause, number)
        self.holdings.acquire(activation, clause.needs[0], spike)
        group = spike.group.root()
        if group.interested:
            self.state.dirty[group] = None
        self.holdings.complete(activation)
        return activation
