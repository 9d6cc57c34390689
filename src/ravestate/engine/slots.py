"""Slots: a write changes a value and raises the slot's signals (laws L2, L13)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, cast

from ravestate.declare.slot import Entry
from ravestate.engine import trace
from ravestate.engine.activation import Activation
from ravestate.engine.group import NOTHING
from ravestate.engine.matching import Matching
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.errors import RuleError, UndeclaredError
from ravestate.policy.model import SignalPlan, SlotPlan


class Slots:
    """The part of the engine that writes slots and raises their signals."""

    __slots__ = ("matching", "state")

    def __init__(self, state: State, matching: Matching) -> None:
        self.state = state
        self.matching = matching

    def write(self, slot: SlotPlan, value: Any, run: Activation | None, origin: Any = None) -> None:
        """Write a slot, for a run or for code outside the rules. An equal value changes nothing, unless the slot has
        `always`."""
        if slot.is_collection:
            self._replace(slot, value, run, origin)
            return
        _mark_write(slot, run)
        if slot.is_flag:
            value = bool(value)
        if slot.always or not equal(self.state.read(slot.index), value):
            self._change(slot, value, self.matching.parents(run), run, origin)

    def set_flag(self, flag: SlotPlan, value: bool) -> None:
        """Change a built-in flag, and raise its signals only if a rule, the tracer or the runtime may hear them."""
        state = self.state
        if flag.heard or state.tracer is not None or self._is_watched(flag) or flag.guarded:
            self._change(flag, value, (), None)
        else:
            state.values[flag.index] = value

    def store(self, slot: SlotPlan, key: str, item: Any, run: Activation | None) -> None:
        """Store an item of a collection; `ABSENT` removes the present item. An equal item changes nothing (L2)."""
        _mark_write(slot, run)
        self._change_item(slot, key, item, run)

    def _change(
        self, slot: SlotPlan, value: Any, parents: tuple[Spike, ...], run: Activation | None, origin: Any = None
    ) -> None:
        """Set the value of a value or flag slot, and raise its signals if something may hear them (L2, L13)."""
        state, matching = self.state, self.matching
        state.values[slot.index] = value
        if state.tracer is not None:
            state.tracer(trace.Set(state.now, slot.name, value, 0 if run is None else run.id))
        if slot.heard or state.tracer is not None or self._is_watched(slot):
            group = matching.group_of(parents)
            if slot.keep_latest:
                for signal in slot.signals:
                    matching.holdings.withdraw(signal, "superseded")
            raised = slot.signals
            if slot.is_flag:
                raised = (slot.signals[0], slot.signals[1] if value else slot.signals[2])
            for signal in raised:
                matching.birth(signal, value, parents, group, run, origin)
        elif len(parents) > 1:
            matching.group_of(parents)  # the parents' groups merge (L11), although no rule hears the slot
        if slot.guarded:
            self._regate(slot)

    def _change_item(self, slot: SlotPlan, key: str, item: Any, run: Activation | None, origin: Any = None) -> None:
        state, matching = self.state, self.matching
        items = state.unseen.get(slot.index)
        old: Mapping[str, Any] = state.read(slot.index) if items is None else items
        known = old.get(key, ABSENT)
        if known is item or (known is not ABSENT and item is not ABSENT and equal(known, item)):
            return
        if items is None:
            items = dict(old)
            state.values[slot.index] = MappingProxyType(items)
        if state.tracer is None:
            if state.unseen is NOTHING:
                state.unseen = {}
            state.unseen[slot.index] = items
        changed, added, removed = slot.signals
        raised: tuple[SignalPlan, ...] = (changed,)
        if item is ABSENT:
            items.pop(key, None)
            raised = (changed, removed)
        else:
            if known is ABSENT:
                raised = (changed, added)
            items[key] = item
        if state.tracer is not None:
            state.unseen.pop(slot.index, None)
            state.tracer(trace.Set(state.now, slot.name, items, 0 if run is None else run.id))
        entry = Entry(key, known if item is ABSENT else item)
        parents = matching.parents(run)
        group = matching.group_of(parents)
        for signal in raised:
            if signal.keep_latest:
                matching.holdings.withdraw(signal, "superseded")
            matching.birth(signal, entry, parents, group, run, origin)
        if slot.guarded:
            self._regate(slot)

    def _replace(self, slot: SlotPlan, value: Any, run: Activation | None, origin: Any) -> None:
        """Replace all items of a collection; each item that differs from its present value is a separate write."""
        if not isinstance(value, Mapping):
            raise RuleError(f"{slot.name} is a collection: write a mapping of keys to items, not {value!r}")
        _mark_write(slot, run)
        items = cast("Mapping[str, Any]", value)
        old: Mapping[str, Any] = self.state.read(slot.index)
        for key in [*[k for k in old if k not in items], *items]:
            self._change_item(slot, key, items.get(key, ABSENT), run, origin)

    def _is_watched(self, slot: SlotPlan) -> bool:
        """Return whether the runtime wants a report of the spikes of one of the slot's signals."""
        watched = self.state.watched
        if watched:
            for signal in slot.signals:
                if signal.name in watched:
                    return True
        return False

    def _regate(self, slot: SlotPlan) -> None:
        """Judge the predicates on a slot again, because its value has changed."""
        state = self.state
        for activation in list(state.gated):
            if activation in state.gated and any(guarded is slot for guarded, _ in activation.clause.guards):
                del state.gated[activation]
                self.matching.holdings.update(activation)
        state.asking.update(state.waiting)
        for clause, watches in list(state.watches.items()):
            for watch in list(watches.values()) if clause.guards else ():
                self.matching.runs.judge(watch)


def _mark_write(slot: SlotPlan, run: Activation | None) -> None:
    """Record that a run writes a slot; refuse the write if the rule does not declare it (L3)."""
    if run is not None:
        if slot.index not in run.clause.rule.slotset:
            raise UndeclaredError(
                f"rule {run.clause.rule.name} wrote {slot.name} without declaring it: declare writes={slot.name}"
            )
        run.wrote = True


class _Absent:
    def __repr__(self) -> str:
        return "absent"


ABSENT: Any = _Absent()
"""The mark for "no item": it stands in the place of an item that a collection does not have."""


def equal(old: Any, new: Any) -> bool:
    """Return whether two values are equal. Values that cannot be compared, such as arrays, count as different."""
    if old is new:
        return True
    try:
        return bool(old == new)
    except Exception:  # a value's own comparison may raise anything
        return False
