"""The agenda: the order in which ready activations start, ask for consent, or wait (L15-L17, L22).

1. Rules that write no slot start at once.
2. When none of them is left, ready writers ask for consent (``consent.py``): older causes first, and the greatest
   utility first within a cause. By then, rules that never suspend have ended.
3. When no writer may start either, the engine updates the built-in flags.

So when a classifier ends, a waiting activation asks again in the same instant, but only after everything else that ends
in this instant.
"""

from __future__ import annotations

import heapq

from ravestate.engine.activation import READY, WAITING, Activation
from ravestate.engine.consent import Consent
from ravestate.engine.loops import MANY
from ravestate.engine.runs import Runs
from ravestate.engine.slots import Slots
from ravestate.engine.stalemate import stalemate
from ravestate.engine.state import State

BATCH = 100
"""The number of activations without consent that start before the events of their runs are received."""

Turn = tuple[int, float, int, int, Activation]
"""A place in the queue of those that ask: the oldest cause, then the sort key of the activation (`State.order`)."""


class Agenda:
    """The part of the engine that decides which ready activations start."""

    __slots__ = ("breakers", "consent", "queue", "runs", "slots", "state")

    def __init__(self, state: State, runs: Runs, slots: Slots, consent: Consent) -> None:
        self.state = state
        self.runs = runs
        self.slots = slots
        self.consent = consent
        self.queue: list[Turn] = []
        """The activations that ask in this instant, the best first."""
        self.breakers: list[tuple[tuple[float, int, int], Activation]] = []
        """The activations that wait for nothing but each other, the best first."""

    def start_free(self) -> None:
        """Start ready activations that need no consent, in the order of their newest spikes, unless a guard is false."""
        state = self.state
        started = 0
        while started < BATCH and (activation := state.free.pop()) is not None:
            if activation.clause.guards and not self._is_open(activation):
                continue
            if state.loops.runs > MANY and state.loops.defer(activation):
                continue
            self.runs.start(activation)
            started += 1

    @property
    def has_questions(self) -> bool:
        """Whether activations may ask for consent now."""
        state = self.state
        return bool(self.queue or state.asking or state.dirty or state.stirred or state.refused or state.stuck)

    def consent_round(self) -> None:
        """Let ready activations ask for consent: older causes first, and the best activation first within a cause.

        If a rule has just started, an activation that reads one of its slots asks in the next round instead. So the
        activation sees the values that this rule writes before it suspends.
        """
        state, queue = self.state, self.queue
        state.standing.now = state.now
        asking = self.consent.holdings.waits.wake()
        for entry in queue:  # the places of those left may have changed since the last round
            if entry[4].state in (READY, WAITING):
                asking[entry[4]] = None
        queue.clear()
        if len(asking) == 1:
            queue += [(0, 0.0, 0, 0, activation) for activation in asking]
        else:
            queue += [self._turn(activation) for activation in asking]
            heapq.heapify(queue)
        written: set[int] = set()
        later: list[Turn] = []
        while queue:
            entry = heapq.heappop(queue)
            activation = entry[4]
            clause = activation.clause
            if activation.state not in (READY, WAITING) or (clause.guards and not self._is_open(activation)):
                continue
            if state.loops.runs > MANY and activation.state is READY and state.loops.defer(activation):
                continue
            rule = clause.rule
            if written and not rule.readable.isdisjoint(written):
                if _is_taken(activation):
                    later.append(entry)  # by the next round it waits, or has lost its spike
                elif self._has_consent(activation):
                    later.append(entry)
                    break
            elif self._has_consent(activation):
                self.runs.start(activation)
                written.update(rule.slots)
        for entry in later:
            heapq.heappush(queue, entry)
        if not (queue or state.asking or state.dirty or state.stirred or state.acts or state.free):
            self._break_stalemate()

    def settle_flags(self) -> bool:
        """Update ``core:activity`` and ``core:pressure`` (L22); return whether one has changed."""
        state = self.state
        pressure = False
        if state.alternatives or state.waiting:
            pressure = any([not a.clause.reflexive for a in (*state.alternatives, *state.waiting)])
        if pressure != state.values.get(state.pressure.index, False):
            self.slots.set_flag(state.pressure, pressure)
            return True
        activity = state.busy > 0
        if activity != state.values.get(state.activity.index, False):
            self.slots.set_flag(state.activity, activity)
            return True
        return False

    def _has_consent(self, activation: Activation) -> bool:
        """Return whether an activation has consent; if it has not, it waits."""
        refusal = self.consent.ask(activation)
        if refusal.names:
            self.consent.holdings.waits.begin(activation, refusal)
            return False
        return True

    def _is_open(self, activation: Activation) -> bool:
        """Return whether the activation's predicates on slots are true; if not, the activation is no longer ready."""
        if self.state.is_open(activation.clause):
            return True
        self.consent.holdings.unready(activation)
        self.consent.holdings.update(activation)
        return False

    def _turn(self, activation: Activation) -> Turn:
        """Return the activation's place in the queue: older causes first, and the best first within a cause."""
        groups = activation.firm_groups()
        cause = groups[0].id if len(groups) == 1 else min([group.id for group in groups])
        return (cause, *self.state.order(activation), activation)

    def _break_stalemate(self) -> None:
        """Start the best of the activations that wait for nothing but each other, if there are any."""
        state, breakers = self.state, self.breakers
        if not (state.refused or state.stuck):
            return
        found = stalemate(self.consent, state.refused, state.stuck)
        state.refused.clear()
        for activation in found:
            if activation not in state.stuck:
                state.stuck[activation] = None
                heapq.heappush(breakers, (state.order(activation), activation))
        while breakers:
            order, best = heapq.heappop(breakers)
            if best not in state.stuck:
                continue  # it has asked again since
            if order != state.order(best):
                heapq.heappush(breakers, (state.order(best), best))  # its rule has run meanwhile
                continue
            for group in best.firm_groups():
                for other in group.interested:  # what these wait for depends on the group, and so on this start
                    state.stuck.pop(other, None)
                    state.refused[other] = None
            self.runs.start(best)
            break


def _is_taken(activation: Activation) -> bool:
    """Return whether one of the activation's slots is taken in each of its groups."""
    slots = activation.clause.rule.slotset
    return all([not group.taken.keys().isdisjoint(slots) for group in activation.firm_groups()])
