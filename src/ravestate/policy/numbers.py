"""The numeric arguments of rules, such as weight and cooldown: their values, and checks of their range."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.declare.settings import Number, SettingRef
from ravestate.declare.wording import short
from ravestate.errors import nearest


class Numbers:
    """Checks the numeric arguments of rules, and replaces settings with their values.

    It adds a fault to `faults` for each argument out of range, and for each setting that is missing or is no number.
    `refers` is true if a rule refers to a setting.
    """

    def __init__(self, modules: Sequence[Module], settings: Mapping[str, Any], faults: list[str]) -> None:
        self.faults = faults
        self.refers = False
        self._modules = modules
        self._named = {module.name: module for module in modules}
        self._settings = settings

    def number(
        self, rule: Rule[Any, Any], number: Number, what: str, valid: Callable[[float], bool], wanted: str
    ) -> float:
        """Return the value of a rule's argument `what`. If the value is not `valid`, add a fault and return 1.

        `wanted` describes a valid value, for the fault's message.
        """
        where = f"rule {rule.name} ({rule.origin}): {what}"
        source = repr(number)
        if isinstance(number, SettingRef):
            self.refers = True
            found = self._setting(rule, number, where)
            if found is None:
                return 1.0
            source = f"{number!r} = {found!r}"
            number = found
        if not math.isfinite(number):
            wanted = f"a finite number, {wanted}"
        if not math.isfinite(number) or not valid(number):
            self.faults.append(f"{where}={source} must be {wanted}")
            return 1.0
        return float(number)

    def _setting(self, rule: Rule[Any, Any], ref: SettingRef, where: str) -> float | None:
        """Return the number in a setting. If there is no such number, add a fault and return None.

        The owner of a reference is a settings class. A reference without an owner means the rule's own module.
        """
        own = self._named.get(rule.name.split(":")[0])
        module = own
        if ref.owner is not None and (own is None or own.settings is not ref.owner):
            module = next((m for m in self._modules if m.settings is ref.owner), own)
        if module is None or module.settings is None:
            self.faults.append(
                f"{where}={ref!r}: module {rule.name.split(':')[0]} has no settings: write "
                f"rs.Module({rule.name.split(':')[0]!r}, settings=Settings) with a field {ref.name}"
            )
            return None
        values = self._settings.get(module.name)
        if values is None:
            fields: Mapping[str, Any] = getattr(module.settings, "model_fields", {})
            if ref.name not in fields:
                self.faults.append(
                    f"{where}={ref!r}: settings of module {module.name} have no field {ref.name!r}"
                    f"{nearest(ref.name, fields)}"
                )
                return None
            value = fields[ref.name].get_default(call_default_factory=True)
        else:
            value = getattr(values, ref.name, None)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            self.faults.append(
                f"{where}={ref!r}: the setting is {short(value)}, not a number; give it a number as its default"
            )
            return None
        return float(value)
