"""The queue of the ready activations that need no consent: they start in the order of their newest spikes (law L24)."""

from __future__ import annotations

from typing import Any

from ravestate.engine.activation import READY, Activation
from ravestate.engine.line import Line


class Free(Line):
    """A queue of ready activations. Most join at its end. An activation whose spikes have changed may join anywhere.

    Attributes:
        new: The activations that have become ready since the last call of `pop`.
        batch: Activations that became ready while the queue was empty, in reverse order. There may be thousands. They
            get places (sort keys, ``line.py``) only if other activations join before the whole batch has started.
    """

    __slots__ = ("batch", "new")

    def __init__(self) -> None:
        super().__init__()
        self.new: list[Activation] = []
        self.batch: list[Activation] = []

    @property
    def is_empty(self) -> bool:
        """Whether the queue has no activation."""
        return not (self.new or self.batch or self.line)

    def pop(self) -> Activation | None:
        """Remove the first activation that is still ready, and return it; None if there is none."""
        new, line = self.new, self.line
        if len(new) == 1 and not (line or self.batch):
            activation = new.pop()
            return activation if activation.state == READY else None
        if new:
            self._take_up(new)
        batch = self.batch
        while batch:
            activation = batch.pop()
            if activation.state == READY:
                return activation
        while line:
            place = self.take()
            activation = place[3]
            if activation.place == place:  # else the activation has another place by now
                activation.place = None
                if activation.state == READY:
                    return activation
        return None

    def _take_up(self, new: list[Activation]) -> None:
        """Add the new activations to the queue."""
        places = [_place(activation) for activation in self.batch]
        for activation in new:
            activation.newest = max([spike.id for spike in activation.spikes if spike is not None], default=0)
        if self.line or places:
            self.join([*places, *[_place(activation) for activation in new]])
            self.batch.clear()
            new.clear()
            return
        if not _is_sorted(new):
            new.sort(key=_order)
        new.reverse()
        self.batch, self.new = new, self.batch


def _is_sorted(activations: list[Activation]) -> bool:
    """Return whether activations are in order; most often they are."""
    before = activations[0]
    for activation in activations:
        if before.newest > activation.newest or (
            before.newest == activation.newest and _order(before) > _order(activation)
        ):
            return False
        before = activation
    return True


def _order(activation: Activation) -> tuple[int, int, int]:
    """Return the sort key of an activation: the number of its newest spike, its clause's index, and its own number."""
    return (activation.newest, activation.clause.index, activation.id)


def _place(activation: Activation) -> Any:
    """Give an activation a place in the queue (see `_order`), and return the place."""
    activation.place = (activation.newest, activation.clause.index, activation.id, activation)
    return activation.place
