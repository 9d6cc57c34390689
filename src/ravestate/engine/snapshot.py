"""The state of an engine as plain data, for debuggers and logs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from ravestate.declare.wording import shown
from ravestate.engine.explain import activations, stand_ins

if TYPE_CHECKING:
    from ravestate.engine.engine import Engine


def snapshot(engine: Engine) -> dict[str, Any]:
    """Return all live objects of an engine as dictionaries, lists, strings and numbers.

    `plain` converts payloads and values of other types.

    Returns:
        ``now`` (seconds), ``slots``, ``spikes``, ``activations``, ``groups``, ``dropped``, ``retired``,
        ``next_deadline`` (seconds or None).
    """
    state = engine.state
    by_rule = activations(state)
    holders: dict[int, list[int]] = {}
    for others in stand_ins(state).values():
        for other in others:
            for spike in other.spikes:
                if spike is not None:
                    holders.setdefault(spike.id, []).append(other.id)
    groups = {spike.group.root() for spikes in state.live.values() for spike in spikes}
    found: dict[str, Any] = {
        "now": state.now,
        "slots": {plan.name: plain(state.read(plan.index)) for plan in state.policy.slot_plans},
        "spikes": [
            {
                "id": spike.id,
                "signal": spike.signal.name,
                "age": state.now - spike.born,
                "group": spike.group.root().id,
                "parents": [parent.id for parent in spike.parents],
                "payload": plain(spike.payload),
                "holders": [*(holder.id for holder in spike.holders), *holders.get(spike.id, ())],
            }
            for spikes in state.live.values()
            for spike in spikes
        ],
        "activations": [
            {
                "id": one.id,
                "rule": rule.name,
                "state": one.state,
                "condition": one.condition,
                "holds": [{"signal": signal, "age": age} for signal, age in one.holds],
                "lacks": list(one.lacks),
                "waits_for": [{"rule": name, "nats": nats} for name, nats in one.waits_for],
                "until": one.until,
            }
            for rule in state.policy.rule_plans
            for one in by_rule.get(rule.index, ())
        ],
        "groups": [
            {
                "id": group.id,
                "taken": {
                    state.policy.slot_plans[slot].name: None
                    if holders is None
                    else [holder.clause.rule.name for holder in holders]
                    for slot, holders in group.taken.items()
                },
            }
            for group in sorted(groups, key=lambda group: group.id)
        ],
        "dropped": dict(state.dropped),
        "retired": [rule.name for rule in state.policy.rule_plans if rule.index in state.retired],
        "next_deadline": engine.next_deadline(),
    }
    engine.rest()
    return found


def plain(value: Any) -> Any:
    """Return a value as data that JSON can carry: a set or tuple becomes a list, and any unknown type its ``repr``."""
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
