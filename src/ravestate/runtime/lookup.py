"""A check that a slot or a signal belongs to a context's policy. Its error message suggests a correction."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.declare.wording import spelt
from ravestate.errors import UndeclaredError, nearest


def check_known(
    thing: object, known: Mapping[str, Any], kind: type[Slot[Any] | Signal[Any]], rule: Rule[Any, Any] | None = None
) -> None:
    """Refuse a value that is not among a policy's slots or signals.

    Args:
        thing: The value.
        known: The policy's slots or signals, by name.
        kind: `Slot` if `known` has slots, `Signal` if it has signals.
        rule: The rule that uses the value; None for code outside the rules.

    Raises:
        UndeclaredError: The policy does not have the slot or the signal.
    """
    name = getattr(thing, "name", None)
    if isinstance(name, str) and known.get(name) is thing:
        return
    by, home = "", ""
    if rule is not None:
        by, home = f"rule {rule.name} ({rule.origin}): ", rule.name.split(":")[0]
    what, hint = kind.__name__.lower(), ""
    if isinstance(thing, Slot) and kind is Signal:
        hint = f"; it is a slot: write {spelt(str(name), home)}.changed"
    elif isinstance(name, str):
        hint = nearest(name, known) or f"; add module {name.split(':')[0]} to the context"
    raise UndeclaredError(f"{by}this context has no {what} {thing!r}{hint}")
