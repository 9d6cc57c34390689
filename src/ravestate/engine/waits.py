"""Waiting: the changes after which an activation that was refused consent asks again (laws L15, L16).

Each waiting activation keeps the reasons for its wait, a `Refusal`. It asks again when one of the following things
changes:

- a causal group on which the refusal depends (`Refusal.interests`)
- a *hope*: something outside these groups that may lift the refusal, such as a live rule of another group
  (``activation.py``)

It also asks again at the time `Refusal.recheck`, and when its own rule or a rival's rule begins a cooldown. All waiting
activations ask again when the rules change, or when a slot with predicates changes. When an activation changes,
`Waits.stir_rule` finds the hopes that depend on the activation's rule.
"""

from __future__ import annotations

from ravestate.engine import trace
from ravestate.engine.activation import NEVER, OUTSIDE, REFUSE, RULE, Activation, Refusal
from ravestate.engine.deadlines import RECHECK
from ravestate.engine.group import NOTHING
from ravestate.engine.state import State
from ravestate.policy.model import Half, RulePlan


class Waits:
    """The part of the engine that keeps the tables of the waiting activations."""

    __slots__ = ("state",)

    def __init__(self, state: State) -> None:
        self.state = state

    def begin(self, activation: Activation, refusal: Refusal) -> None:
        """Make an activation wait for the reasons in `refusal`, and record the changes after which it asks again."""
        state = self.state
        before = activation.refusal
        activation.step(REFUSE)
        self.end(activation)
        activation.refusal = refusal
        state.waiting[activation] = state.refused[activation] = None
        if refusal.hopes and state.hoping is NOTHING:
            state.hoping, state.hope_counts, state.stirred = {}, {}, {}
        for hope, most in refusal.hopes.items():
            state.hoping.setdefault(hope, {})[activation] = None
            state.hope_counts[hope] = max(most, state.hope_counts.get(hope, 0))
        for group in refusal.interests:
            group.concern(activation)
        if refusal.recheck < NEVER:
            state.deadlines.add(refusal.recheck, RECHECK, activation)
        if state.tracer is not None:
            refusal.told = () if before is None else before.told
            if self._tell(activation, refusal) and before is not None:
                self.tell_followers()

    def tell_followers(self) -> None:
        """Record in the trace which rules the *followers* wait for, after the waits of their leaders have changed.

        A follower is an activation that waits for a better one, its leader, and examines no other rival
        (``leaders.py``).
        """
        for other in self.state.waiting:
            if other.refusal is not None and other.refusal.leader is not None:
                self._tell(other, other.refusal)

    def _tell(self, activation: Activation, refusal: Refusal) -> bool:
        """Record in the trace the rules that a refusal names, unless the trace has them already. Return whether they
        are new."""
        state = self.state
        names = tuple(refusal.all_names)
        if names == refusal.told or state.tracer is None:
            return False
        refusal.told = names
        until = None if refusal.blockers else patience_of_rivals(state, activation)
        state.tracer(trace.Waits(state.now, activation.id, activation.clause.rule.name, names, until))
        return True

    def end(self, activation: Activation) -> None:
        """Make an activation stop waiting: forget the changes after which it would ask again."""
        state = self.state
        refusal = activation.refusal
        if refusal is None:
            return
        activation.refusal = None
        state.waiting.pop(activation, None)
        state.refused.pop(activation, None)
        if state.stuck:
            state.stuck.discard(activation)
        for hope in refusal.hopes:
            hoping = state.hoping.get(hope)
            if hoping is not None:
                hoping.pop(activation, None)
                if not hoping:
                    del state.hoping[hope], state.hope_counts[hope]
        for group in refusal.interests:
            group.root().forget(activation)

    def stir(self, activation: Activation) -> None:
        """Make the activations that wait for this one ask again, because its spikes have changed."""
        for group in activation.firm_groups():
            if group.interested:
                self.state.dirty[group] = None
        if self.state.hoping:
            self.stir_rule(activation.clause.rule)

    def stir_rule(self, rule: RulePlan) -> None:
        """Record that an activation of a rule began, changed or ended. Activations whose hopes depend on the rule ask
        again."""
        state = self.state
        others = len(state.active.get(rule.index, ())) - 1
        for hope in state.hoping:
            kind, number = hope
            if kind == RULE:
                if number == rule.index:
                    state.stirred[hope] = None
            elif (
                kind == OUTSIDE
                and others <= state.hope_counts[hope]
                and rule.index in state.causes.wide_ancestors(number)
            ):
                state.stirred[hope] = None

    def stir_half(self, half: Half) -> None:
        """Record that a half has taken a spike. Activations whose hopes depend on one of the half's rules ask again.

        A half keeps a spike without an activation, until a second spike comes (``halves.py``).
        """
        state = self.state
        for hope in state.hoping:
            if hope[0] == RULE and hope[1] in half.places:
                state.stirred[hope] = None

    def wake(self) -> dict[Activation, None]:
        """Return the activations that ask for consent now: those newly ready, and those whose refusal may be lifted."""
        state = self.state
        asking = state.asking
        state.asking = {}
        if state.dirty or state.stirred:
            for group in state.dirty:
                asking.update(group.interested)
            state.dirty.clear()
            for hope in state.stirred:
                asking.update(state.hoping.get(hope, {}))
            state.stirred.clear()
        return asking

    def pass_time(self) -> None:
        """Let the next search for a stalemate begin with all activations that wait only for each other (`State.stuck`).

        Time may change the reasons of their waits.
        """
        if self.state.stuck:
            self.state.refused.update(dict.fromkeys(self.state.stuck))
            self.state.stuck.clear()


def patience_of_rivals(state: State, activation: Activation) -> float | None:
    """Return the latest time (seconds) at which the patience of an activation's rivals ends; None without pressure."""
    names = activation.refusal.names if activation.refusal is not None else ()
    clauses = state.policy.clause_plans
    times: list[float] = []
    for group in activation.firm_groups():
        times += [
            m.patience_ends[group] for m in group.members if m.clause.rule.name in names and group in m.patience_ends
        ]
        times += [t for c, t in (group.patience_ends or {}).items() if clauses[c].rule.name in names and t > state.now]
        for spike in group.entries if state.patience_ends else ():
            for half, pressed in state.patience_ends.get(spike, {}).items():
                begin = 0
                for end, until in pressed:
                    if until > state.now and any([n.clause.rule.name in names for n in half.best[begin:end]]):
                        times.append(until)
                    begin = end
    return max(times, default=None)
