"""The queue of the ready activations that need no consent: they start in the order of their newest spikes (L21)."""

from __future__ import annotations

from typing import Any

from ravestate.engine.activation import READY, Activation
from ravestate.engine.line import Line

Place = tuple[int, int, int, Activation]


class Free(Line):
    """A queue of ready activations. Most join at its end; those that lost a spike and took another join anywhere.

    Attributes:
        new: The activations without a place so far.
    """

    __slots__ = ("new",)

    def __init__(self) -> None:
        super().__init__()
        self.new: list[Activation] = []

    def pop(self) -> Activation | None:
        """Remove the first activation that is still ready, and return it; None if there is none."""
        new, line = self.new, self.line
        if len(new) == 1 and not line:
            activation = new.pop()
            return activation if activation.state == READY else None
        if new:
            self.join([_place(activation) for activation in new])
            new.clear()
        while line:
            place = self.take()
            activation = place[3]
            if activation.place == place:  # else it was added again since
                activation.place = None
                if activation.state == READY:
                    return activation
        return None


def _place(activation: Activation) -> Any:
    """Give an activation its place: first in the order of its newest spike, then of declaration."""
    newest = max([spike.id for spike in activation.spikes if spike is not None], default=0)
    activation.place = (newest, activation.clause.index, activation.id, activation)
    return activation.place
