"""Slots: values change, and signals are raised (L2, L13)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, cast

from ravestate.declare.slot import Entry
from ravestate.engine import trace
from ravestate.engine.activation import Activation
from ravestate.engine.matching import Matching
from ravestate.engine.spike import Spike
from ravestate.errors import RuleError, UndeclaredError
from ravestate.policy.model import SlotPlan


class Slots(Matching):
    """The layer of the engine that writes slots and raises their signals."""

    __slots__ = ()

    def _mark_write(self, slot: SlotPlan, run: Activation | None) -> None:
        """Note that a run writes a slot; refuse the write if the rule does not declare it (L3)."""
        if run is not None:
            if slot.index not in run.clause.rule.slotset:
                raise UndeclaredError(f"rule {run.clause.rule.name} writes {slot.name} without writes={slot.name}")
            run.wrote = True

    def _change(self, slot: SlotPlan, value: Any, parents: tuple[Spike, ...], run: Activation | None) -> None:
        """Set the value of a value or flag slot, and raise its signals (L2, L13)."""
        self.values[slot.index] = value
        if self.tracer is not None:
            self.tracer(trace.Set(self.now, slot.name, value, 0 if run is None else run.id))
        if len(parents) > 1:
            self._group_of(parents)  # the parents' groups merge (L11), even if no rule hears the slot
        if slot.heard or self.tracer is not None or (self.watched and self._watched(slot)):
            if slot.keep_latest:
                for signal in slot.signals:
                    self._withdraw(signal, "superseded")
            raised = slot.signals
            if slot.is_flag:
                raised = (slot.signals[0], slot.signals[1] if value else slot.signals[2])
            group = self._group_of(parents)
            for signal in raised:
                self._birth(signal, value, parents, group, run)
        if slot.index in self.policy.guarded:
            self._regate(slot)

    def _change_item(
        self,
        slot: SlotPlan,
        key: str,
        item: Any,
        run: Activation | None,
    ) -> None:
        """Store or remove an item of a collection, and raise the slot's signals. An equal item changes nothing (L2)."""
        items = self._unseen.get(slot.index)
        old: Mapping[str, Any] = self.read(slot.index) if items is None else items
        known = old.get(key, ABSENT)
        if known is item or (known is not ABSENT and item is not ABSENT and equal(known, item)):
            return
        if items is None:
            items = dict(old)
            self.values[slot.index] = MappingProxyType(items)
        if self.tracer is None:
            self._unseen[slot.index] = items
        changed, added, removed = slot.signals
        raised = (changed,)
        if item is ABSENT:
            items.pop(key, None)
            raised = (changed, removed)
        else:
            if known is ABSENT:
                raised = (changed, added)
            items[key] = item
        if self.tracer is not None:
            self._unseen.pop(slot.index, None)
            self.tracer(trace.Set(self.now, slot.name, items, 0 if run is None else run.id))
        entry = Entry(key, known if item is ABSENT else item)
        parents, group = self._origin(run)
        for signal in raised:
            if signal.keep_latest:
                self._withdraw(signal, "superseded")
            self._birth(signal, entry, parents, group, run)
        if slot.index in self.policy.guarded:
            self._regate(slot)

    def _replace(self, slot: SlotPlan, value: Any, run: Activation | None) -> None:
        """Replace all items of a collection; each item that differs counts as a write of its own."""
        if not isinstance(value, Mapping):
            raise RuleError(f"{slot.name} is a collection: write a mapping of keys to items, not {value!r}")
        self._mark_write(slot, run)
        items = cast("Mapping[str, Any]", value)
        old: Mapping[str, Any] = self.read(slot.index)
        for key in [*(k for k in old if k not in items), *items]:
            self._change_item(slot, key, items.get(key, ABSENT), run)

    def _watched(self, slot: SlotPlan) -> bool:
        """Return whether the runtime wants a report of the spikes of one of the slot's signals."""
        return any(signal.name in self.watched for signal in slot.signals)

    def _regate(self, slot: SlotPlan) -> None:
        """Judge the predicates on a slot again, because its value has changed."""
        for activation in list(self.gated):
            if activation in self.gated and any(guarded is slot for guarded, _ in activation.clause.guards):
                del self.gated[activation]
                self._update(activation)
        for activation in self.waiting:
            self._asking[activation] = None
        for clause, watches in list(self._watches.items()):
            for watch in list(watches.values()) if clause.guards else ():
                self._judge(watch)


class _Absent:
    def __repr__(self) -> str:
        return "absent"


ABSENT: Any = _Absent()


def equal(old: Any, new: Any) -> bool:
    """Return whether two values are equal. Values that cannot be compared, such as arrays, count as different."""
    if old is new:
        return True
    try:
        return bool(old == new)
    except Exception:  # a value's own comparison may raise anything
        return False
