"""The agenda: the order in which ready activations start, ask for consent, or wait (laws L15-L17, L22).

1. Activations that need no consent start first: their rules write no slot, or all their constraints are detached.
2. When none of these is left, the other ready activations ask for consent (``consent.py``). Activations with older
   causes ask first. If causes are equal, the activation with the greatest effective utility asks first. By then, the
   ``async`` rules of step 1 that never suspend have ended.
3. When no activation may start, the engine updates the built-in flags. Only the change of ``core:activity`` to true
   comes earlier, before step 1 (``parts.py``).

When a rule ends, the activations that wait for it ask again in the same instant. They ask after all rules that end in
this instant have ended. So the caller must give the engine all events of the instant before it calls `Engine.effects`.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from typing import Any, Final

from ravestate.engine.activation import READY, WAITING, Activation
from ravestate.engine.consent import Consent
from ravestate.engine.line import Line
from ravestate.engine.loops import MANY
from ravestate.engine.runs import Runs
from ravestate.engine.slots import Slots
from ravestate.engine.stalemate import no_longer_stuck, stalemate
from ravestate.engine.state import State
from ravestate.engine.stuck import Stuck

BATCH: Final = 100
"""The maximum number of activations that one call of `start_free` starts. Then the caller reports the events of their
runs."""

Turn = tuple[int, float, int, int, Activation]
"""A place in the queue of activations that ask: the number of the activation's oldest causal group, the
activation's sort key (`State.order`), and the activation itself."""


class Agenda:
    """The part of the engine that decides which ready activations start."""

    __slots__ = ("breakers", "consent", "places", "queue", "recovering", "runs", "slots", "state", "time")

    def __init__(self, state: State, runs: Runs, slots: Slots, consent: Consent) -> None:
        self.state = state
        self.runs = runs
        self.slots = slots
        self.consent = consent
        self.queue = Line()
        """The activations that ask in this instant, in the order in which they ask."""
        self.places: dict[Activation, Any] = {}
        """Activation in the queue → its valid place. The queue may also hold outdated places of the activation."""
        self.recovering = False
        """Whether time changes the order of the queue, because activations of rules with a cooldown are in it."""
        self.time = 0.0
        """The time (seconds) at which the queue was last put in order."""
        self.breakers: list[tuple[tuple[float, int, int], Activation]] = []
        """A heap of the activations that wait only for each other, each with its sort key. Entries may be outdated."""

    def start_free(self) -> None:
        """Start at most `BATCH` ready activations that need no consent, in the order of their newest spikes.

        An activation whose slot predicates (*guards*) have become false is no longer ready.
        """
        state = self.state
        free = state.free
        started = 0
        while started < BATCH and (free.new or free.batch or free.line):
            activation = free.pop()
            if activation is None or (activation.clause.guards and not self._pass_guards(activation)):
                continue
            if state.loops.runs > MANY and state.loops.defer(activation):
                continue
            self.runs.start(activation)
            started += 1

    @property
    def has_questions(self) -> bool:
        """Whether activations may ask for consent now."""
        state = self.state
        return bool(
            self.queue.line
            or state.asking
            or state.dirty
            or state.stirred
            or state.headless
            or state.refused
            or state.stuck
        )

    def consent_round(self) -> None:
        """Let ready activations ask for consent: oldest cause first, and for one cause the best activation first.

        Suppose that a rule has started in this round, and an activation may read a slot that the rule writes. Then the
        activation starts in the next round at the earliest. By then, the rule has made the writes that precede its
        first suspension, and the activation sees them.
        """
        state, queue, places = self.state, self.queue, self.places
        line = queue.line
        state.standing.now = state.now
        self.consent.holdings.benches.settle()
        asking = self.consent.holdings.waits.wake()
        if not line and len(asking) == 1:
            for activation in asking:
                if self._may_ask(activation) and self._ask(activation):
                    self.runs.start(activation)
        else:
            self._line_up(asking)
        written: set[int] = set()
        later: list[Any] = []
        while line:
            turn = queue.take()  # not unpacked, because it is compared as a whole
            activation = turn[4]
            if places.get(activation) != turn:
                continue  # the activation has another place by now
            del places[activation]
            if not self._may_ask(activation):
                continue
            rule = activation.clause.rule
            if written and not rule.readable.isdisjoint(written):
                if _is_taken(activation):
                    later.append(turn)  # in the next round, the activation waits, or has lost its spike
                elif self._ask(activation):
                    later.append(turn)
                    break
            elif self._ask(activation):
                self.runs.start(activation)
                written.update(rule.slots)
        if self.consent.leaders.found:
            self.consent.leaders.found.clear()
        for turn in later:
            places[turn[4]] = turn
        if later:
            queue.join(later)
        if not (line or state.asking or state.dirty or state.stirred or state.acts) and state.free.is_empty:
            self._break_stalemate()

    def settle_flags(self) -> bool:
        """Update one built-in flag that is out of date, ``core:pressure`` first (L22). Return whether there was one."""
        state = self.state
        pressure = bool(
            state.benches
            or (state.waiting and _presses(state.waiting))
            or (state.alternatives and _presses(state.alternatives))
        )
        if pressure != state.values.get(state.pressure.index, False):
            self.slots.set_flag(state.pressure, pressure)
            return True
        activity = state.busy > 0
        if activity != state.values.get(state.activity.index, False):
            self.slots.set_flag(state.activity, activity)
            return True
        return False

    def _line_up(self, asking: dict[Activation, None]) -> None:
        """Give activations their places in the queue. If the order has changed, the whole queue gets new places."""
        state, queue, places = self.state, self.queue, self.places
        if state.reordered or (self.recovering and state.now != self.time):
            asking.update(dict.fromkeys(places))
            queue.clear()
            places.clear()
        state.reordered = False
        self.time = state.now
        self.recovering = self.recovering and bool(queue.line)
        turns: list[Any] = []
        for activation in asking:
            if activation.state in (READY, WAITING):
                turn: Any = self._turn(activation)
                if places.get(activation) != turn:
                    places[activation] = turn
                    turns.append(turn)
                    self.recovering = self.recovering or activation.clause.rule.cooldown > 0
        queue.join(turns)

    def _may_ask(self, activation: Activation) -> bool:
        """Return whether an activation may ask: it is ready or waits, its guards (slot predicates) are true, and it is
        not deferred as an iteration of a loop of rules (L23)."""
        if activation.state not in (READY, WAITING):
            return False
        if activation.clause.guards and not self._pass_guards(activation):
            return False
        loops = self.state.loops
        return not (loops.runs > MANY and activation.state == READY and loops.defer(activation))

    def _ask(self, activation: Activation) -> bool:
        """Ask for consent; return whether the activation has it. If not, the activation waits.

        A *bench* keeps first spikes, each of which makes a pair with the same second spike. Only one of these pairs has
        an activation, the *head* of the bench (``benches.py``). If the refused activation is the head of a bench, the
        bench gets a new head, unless the group of the second spike refuses.
        """
        refusal = self.consent.ask(activation)
        if refusal.names:
            self.consent.holdings.waits.begin(activation, refusal)
            if self.state.benches:
                for head in self.consent.holdings.benches.next_heads(activation):
                    del self.state.asking[head]
                    self._line_up({head: None})
            if activation in self.state.alternatives and not refusal.taken and self.consent.is_contested(activation):
                self.consent.halves.sets.unfold(activation)
            return False
        return True

    def _pass_guards(self, activation: Activation) -> bool:
        """Return whether the activation's guards are true. If one is false, the activation is no longer ready."""
        if self.state.is_open(activation.clause):
            return True
        self.consent.holdings.unready(activation)
        self.consent.holdings.update(activation)
        return False

    def _turn(self, activation: Activation) -> Any:
        """Return the activation's place in the queue, a `Turn`: first by age of cause, then by `State.order`."""
        groups, clause = activation.firm_groups(), activation.clause
        cause = groups[0].id if len(groups) == 1 else min([group.id for group in groups])
        return (cause, -self.state.effective(clause), clause.index, activation.id, activation)

    def _break_stalemate(self) -> None:
        """Start the best of the activations that wait only for each other, if there are any."""
        state, breakers = self.state, self.breakers
        if not (state.refused or state.stuck):
            breakers.clear()  # no activation is stuck now
            return
        found = stalemate(self.consent, state.refused, state.stuck)
        state.refused.clear()
        stuck = state.stuck
        if stuck is None:
            if not found:
                return
            stuck = state.stuck = Stuck()
        for activation in found:
            if activation not in stuck:
                stuck.add(activation)
                heapq.heappush(breakers, (state.order(activation), activation))
        while breakers:
            order, best = heapq.heappop(breakers)
            if best not in stuck:
                continue  # this activation has asked again in the meantime
            if order != state.order(best):
                heapq.heappush(breakers, (state.order(best), best))  # its utility has changed since
                continue
            freed = no_longer_stuck(best, stuck)
            # Since an earlier search, a change has freed some activations that it found: search again next round.
            if not found.issuperset(freed):
                for other in freed:
                    stuck.discard(other)
                    state.refused[other] = None
                if best in freed:
                    continue
            for group in best.firm_groups():
                for other in group.interested:  # the start changes the group, so these may no longer be stuck
                    stuck.discard(other)
                    state.refused[other] = None
            self.runs.start(best)
            break


def _is_taken(activation: Activation) -> bool:
    """Return whether a run has taken a slot of the activation in every one of the activation's groups."""
    slots = activation.clause.rule.slotset
    for group in activation.firm_groups():
        if not group.taken or group.taken.keys().isdisjoint(slots):
            return False
    return True


def _presses(activations: Iterable[Activation]) -> bool:
    """Return whether one of the activations counts for ``core:pressure``.

    An activation does not count if its clause hears a built-in flag, or has a predicate on such a flag
    (`Clause.reflexive`).
    """
    for activation in activations:
        if not activation.clause.reflexive:
            return True
    return False
