"""The names of a policy's signals and slots: each name leads to a numbered record."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from ravestate.declare.module import Module
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.errors import nearest
from ravestate.policy.model import SignalPlan, SlotPlan


class Names:
    """The numbered signals and slots that modules declare, in declaration order. Mistakes in them go to `faults`."""

    def __init__(self, modules: Sequence[Module], faults: list[str]) -> None:
        self.faults = faults
        self.signals: list[SignalPlan] = []
        self.slots: list[SlotPlan] = []
        self._modules = Counter(module.name for module in modules)
        self._signal_of: dict[str, SignalPlan] = {}
        self._slot_of: dict[str, SlotPlan] = {}
        for module in modules:
            for signal in module.signals:
                self._number(signal, None)
            for slot in module.slots:
                other = self._slot_of.get(slot.name)
                if other is not None:
                    if other.slot is not slot:
                        self.twice("slot", slot.name, other.slot.origin, slot.origin)
                    continue
                index = len(self.slots)
                plan = SlotPlan(index, slot, tuple(self._number(s, index) for s in slot.signals))
                self.slots.append(plan)
                try:
                    if slot.kind != "collection":
                        copy.deepcopy(slot.default)
                except Exception as error:  # copying runs the value's own code, which may raise anything
                    self.faults.append(
                        f"slot {slot.name} ({slot.origin}) has a default that a context cannot copy ({error}): "
                        "write default=None, and set the slot in a rule on rs.startup"
                    )
                self._slot_of[slot.name] = plan

    def _number(self, signal: Signal[Any], slot: int | None) -> SignalPlan:
        other = self._signal_of.get(signal.name)
        if other is not None:
            if other.signal is not signal:
                self.twice("signal", signal.name, other.signal.origin, signal.origin)
            return other
        plan = SignalPlan(len(self.signals), signal, slot, signal.input)
        self.signals.append(plan)
        self._signal_of[signal.name] = plan
        return plan

    def twice(self, what: str, name: str, first: str, second: str) -> None:
        """Add the fault that two signals, slots or rules (`what`), declared at `first` and `second`, share a name."""
        if self._modules[name.split(":")[0]] < 2:  # `_in_order` (``compile.py``) reports two modules with one name
            self.faults.append(f"two {what}s are named {name!r}: {first} and {second}; rename one")

    def signal(self, signal: Signal[Any], where: str) -> SignalPlan | None:
        """Return the record of a signal that a declaration (`where`) uses.

        If the modules do not declare the signal, add a fault and return None.
        """
        plan = self._signal_of.get(signal.name)
        if plan is not None and plan.signal is signal:
            return plan
        self._unknown("signal", signal.name, signal.origin, self._signal_of, where)
        return None

    def slot(self, slot: Slot[Any], where: str) -> SlotPlan | None:
        """Return the record of a slot, in the same way as `signal`."""
        plan = self._slot_of.get(slot.name)
        if plan is not None and plan.slot is slot:
            return plan
        self._unknown("slot", slot.name, slot.origin, self._slot_of, where)
        return None

    def _unknown(self, what: str, name: str, origin: str, names: Iterable[str], where: str) -> None:
        module = name.split(":")[0]
        if name in names:
            hint = f"the policy has another {what} of that name: two modules are named {module!r}; rename one"
        elif module in self._modules:
            hint = f"module {module} has no such {what}{nearest(name, names)}"
        else:
            hint = f"write requires=[{module}] in the module of the rule, or compile module {module} as well"
        self.faults.append(f"{where}: unknown {what} {name} (declared at {origin}): {hint}")
