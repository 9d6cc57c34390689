"""The memory of an engine: the data that it keeps when nothing is live and nothing is left to do."""

from __future__ import annotations

import copy
from types import MappingProxyType
from typing import Any

from ravestate.engine.group import NO_NUMBERS, NOTHING
from ravestate.policy.policy import Policy

PASSIVE = (int, float, str, bytes, bool, type(None), MappingProxyType)
"""Types whose values contexts may share. A slot's default of any other type is copied for each context."""


class Memory:
    """The slots and counters of an engine, and notes about its rules.

    An engine at rest has nothing else. In a working engine, the `State` has this data.

    Args:
        policy: A policy from ``rs.compile``.
        patience: The patience of rivals under pressure, in seconds, unless their rule sets its own (law L16).
        report_ends: Whether the engine reports the end of each run as an `Ended` effect.
    """

    __slots__ = (
        "activations",
        "blamed",
        "dropped",
        "groups",
        "looped",
        "now",
        "patience",
        "policy",
        "ran",
        "report_ends",
        "retired",
        "runs",
        "spikes",
        "unseen",
        "values",
        "watched",
    )

    def __init__(self, policy: Policy, patience: float, report_ends: bool) -> None:
        self.policy = policy
        self.patience = patience
        self.report_ends = report_ends
        self.now = 0.0
        self.values: dict[int, Any] = {}
        """Index of a slot that was written or read → its value."""
        self.unseen: dict[int, dict[str, Any]] = NOTHING
        """Key: the index of a collection that was not read since its last change; value: its items, which a
        write may change without a copy."""
        self.ran: dict[int, float] = NOTHING
        """Index of a rule with a cooldown → the end (seconds) of its last run that *fired*: the run consumed its
        spikes."""
        self.retired = NO_NUMBERS
        """The indices of the rules that have retired."""
        self.dropped: dict[str, int] = NOTHING
        """Name of a signal → how many of its spikes were dropped because of the signal's limit (L23)."""
        self.watched: dict[str, int] = {}
        """Key: the name of a signal whose spikes are reported as effects; the value is always 1."""
        self.blamed = NO_NUMBERS
        """The `id` of each predicate whose exception was reported."""
        self.looped = NO_NUMBERS
        """The indices of the rules that an error has named for an endless loop."""
        self.activations = 0
        """The number of the newest activation."""
        self.runs = 0
        """The number of the newest run."""
        self.spikes = 0
        """The number of the newest spike."""
        self.groups = 0
        """The number of the newest causal group."""

    def take(self, other: Memory) -> None:
        """Take everything over from another memory. The tables are shared from now on, not copied."""
        self.policy = other.policy
        self.patience = other.patience
        self.report_ends = other.report_ends
        self.now = other.now
        self.values = other.values
        self.unseen = other.unseen
        self.ran = other.ran
        self.retired = other.retired
        self.dropped = other.dropped
        self.watched = other.watched
        self.blamed = other.blamed
        self.looped = other.looped
        self.activations = other.activations
        self.runs = other.runs
        self.spikes = other.spikes
        self.groups = other.groups

    def read(self, slot: int) -> Any:
        """Return the value of the slot with this index."""
        if self.unseen:
            self.unseen.pop(slot, None)
        try:
            return self.values[slot]
        except KeyError:
            default: Any = self.policy.slot_plans[slot].slot.default
            if not isinstance(default, PASSIVE):
                default = copy.deepcopy(default)  # contexts share no state
            self.values[slot] = default
            return self.values[slot]
