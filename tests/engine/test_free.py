"""Activations that need no consent wait in the queue `Free`. They leave it in the order of their newest spikes."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

import ravestate as rs
from engine.test_halves import declared
from ravestate.engine.activation import COMPLETE, GRANT, LOSE, Activation
from ravestate.engine.free import Free
from ravestate.engine.group import Group
from ravestate.engine.spike import Spike

numbers = st.integers(1, 20)
steps = st.one_of(st.lists(numbers), st.just("pop"), st.tuples(numbers, numbers))


class Model:
    """A queue, and the activations that wait in it, each with the number of its spike."""

    def __init__(self) -> None:
        m = rs.Module("m")
        declared(m, "rule", when=m.signal("signal"))
        self.policy = rs.compile(m)
        self.free = Free()
        self.waiting: dict[Activation, int] = {}
        self.count = 0

    def join(self, spike: int) -> None:
        self.count += 1
        self.ready(Activation(self.count, self.policy.rule_plan("m:rule").clauses[0]), spike)

    def move(self, place: int, spike: int) -> None:
        """Let a waiting activation lose its spike and take another one."""
        if self.waiting:
            activation = [*self.waiting][place % len(self.waiting)]
            activation.step(LOSE)
            self.ready(activation, spike)

    def ready(self, activation: Activation, spike: int) -> None:
        signal = self.policy.signal_of["m:signal"]
        activation.put(activation.clause.needs[0], Spike(spike, signal, None, 0.0, Group(spike), (), -1, 0))
        activation.step(COMPLETE)
        self.waiting[activation] = spike
        self.free.new.append(activation)

    def pop(self) -> None:
        popped = self.free.pop()
        least = min(self.waiting, key=lambda one: (self.waiting[one], one.id), default=None)
        assert popped is least
        if popped is not None:
            del self.waiting[popped]
            popped.step(GRANT)


@given(st.lists(steps))
def test_the_oldest_cause_comes_first(plays: list[list[int] | str | tuple[int, int]]) -> None:
    model = Model()
    for play in plays:
        if isinstance(play, list):
            for spike in play:
                model.join(spike)
        elif isinstance(play, tuple):
            model.move(*play)
        else:
            model.pop()
    while model.waiting:
        model.pop()
    model.pop()
    assert model.free.is_empty
