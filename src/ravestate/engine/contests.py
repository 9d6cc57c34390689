"""Contests: clauses that would all be ready with the same spike, and of which only one can run.

A thousand rules on one signal that write one slot are a thousand activations, of which one runs and the rest
give up. So only the best of them is made; the others sit on its *bench*. If it resigns or fails, the next takes
its place. Whenever anybody might see a difference (a rival is to be judged, something is to be explained, a rule
retires or is added), the bench is *unfolded* into ordinary activations. The numbers of activations are given as
if all had been made at once, so that nothing depends on when that happens.
"""

from __future__ import annotations

from ravestate.engine.activation import Activation
from ravestate.engine.holdings import Holdings
from ravestate.engine.spike import Spike
from ravestate.policy.model import Clause, SignalPlan

__all__ = ["Contests"]


class Contests(Holdings):
    """Holdings, and those of the activations that stand for others besides themselves."""

    def unfold(self, activation: Activation) -> None:
        """Make activations of all that sit on the bench of one."""
        clauses, made, base = self.benches.pop(activation)
        spike = activation.spikes[0]
        assert spike is not None  # it is ready, or runs
        for position in range(made, len(clauses)):
            self._field(clauses[position], base + position + 1, spike)

    def unfold_all(self) -> None:
        """Make activations of all that sit on a bench."""
        for activation in list(self.benches):
            self.unfold(activation)

    def _contest(self, signal: SignalPlan, spike: Spike) -> None:
        """Offer a spike to the contests of its signal."""
        for clauses in signal.contests:
            if spike.group.finished(clauses[0].rule.slots):
                for clause in clauses if self.tracer is not None else ():
                    self._pass_by(clause, spike, "consumed")
                continue  # consumed for all of them
            clauses = tuple(clause for clause in clauses if self._enters(clause, spike))
            if not clauses:
                continue
            base = self._activations
            self._activations += len(clauses)
            self._next(clauses, 0, base, spike)
        if self.tracer is not None:
            self.unfold_all()

    def _enters(self, clause: Clause, spike: Spike) -> bool:
        if self.retired and clause.rule.index in self.retired:
            return False
        for predicate in clause.needs[0].predicates:
            if not self._test(predicate, spike.payload, clause.rule):
                self._pass_by(clause, spike, "payload")
                return False
        return True

    def _next(self, clauses: tuple[Clause, ...], position: int, base: int, spike: Spike) -> None:
        """Make an activation of the clause at a position, with the rest of the contest on its bench."""
        activation = self._field(clauses[position], base + position + 1, spike)
        if position + 1 < len(clauses):
            self.benches[activation] = (clauses, position + 1, base)

    def _substitute(self, activation: Activation) -> None:
        """The best has resigned or failed: the next of its bench takes its place."""
        bench = self.benches.pop(activation, None)
        spike = activation.spikes[0]
        if bench is not None and spike is not None:
            clauses, made, base = bench
            refused = spike.refused or ()
            while made < len(clauses) and clauses[made].rule.index in refused:
                made += 1  # another clause of a rule that gave the spike up for good
            if made < len(clauses):
                self._next(clauses, made, base, spike)

    def _field(self, clause: Clause, number: int, spike: Spike) -> Activation:
        activation = self._new_activation(clause, number)
        self._acquire(activation, clause.needs[0], spike)
        self._complete(activation)
        return activation
