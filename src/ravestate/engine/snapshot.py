"""The state of an engine as plain data, for debuggers and logs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from ravestate.declare.wording import shown
from ravestate.engine.explain import explain

if TYPE_CHECKING:
    from ravestate.engine.engine import Engine


def snapshot(engine: Engine) -> dict[str, Any]:
    """Return all live objects of an engine as dictionaries, lists, texts and numbers.

    A payload or value of any other type appears as its ``repr``.

    Returns:
        ``now`` (seconds), ``slots``, ``spikes``, ``activations``, ``groups``, ``dropped``, ``retired``,
        ``next_deadline`` (seconds or None).
    """
    engine.look()
    groups = {spike.group.root() for spikes in engine.live.values() for spike in spikes}
    return {
        "now": engine.now,
        "slots": {plan.name: plain(engine.read(plan.index)) for plan in engine.policy.slot_plans},
        "spikes": [
            {
                "id": spike.id,
                "signal": spike.signal.name,
                "age": engine.now - spike.born,
                "group": spike.group.root().id,
                "parents": [parent.id for parent in spike.parents],
                "payload": plain(spike.payload),
                "holders": [holder.id for holder in spike.holders],
            }
            for spikes in engine.live.values()
            for spike in spikes
        ],
        "activations": [
            {
                "id": state.id,
                "rule": rule.name,
                "state": state.state,
                "condition": state.condition,
                "holds": [{"signal": signal, "age": age} for signal, age in state.holds],
                "lacks": list(state.lacks),
                "waits_for": [{"rule": name, "nats": nats} for name, nats in state.waits_for],
                "until": state.until,
            }
            for rule in engine.policy.rule_plans
            if rule.index in engine.active
            for state in explain(engine, rule).activations
        ],
        "groups": [
            {
                "id": group.id,
                "taken": {
                    engine.policy.slot_plans[slot].name: None
                    if holders is None
                    else [holder.clause.rule.name for holder in holders]
                    for slot, holders in group.taken.items()
                },
            }
            for group in sorted(groups, key=lambda group: group.id)
        ],
        "dropped": dict(engine.dropped),
        "retired": [rule.name for rule in engine.policy.rule_plans if rule.index in engine.retired],
        "next_deadline": engine.next_deadline(),
    }


def plain(value: Any) -> Any:
    """Return a value as data that JSON can carry; a value of any other type becomes its ``repr``."""
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Mapping):
        return {
            key if isinstance(key, str) else shown(key): plain(item)
            for key, item in cast("Mapping[Any, Any]", value).items()
        }
    if isinstance(value, (set, frozenset)):
        value = sorted(cast("set[Any]", value), key=shown)
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in cast("list[Any]", value)]
    return shown(value)
