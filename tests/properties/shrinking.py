"""Shrinking: find the smallest world that still has the fault of a given world."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from properties.worlds import Act, RuleOf, SignalOf, SlotOf, Want, World, compiled
from ravestate.errors import DeclarationErrors


def smaller(world: World) -> Iterator[World]:
    """Yield simpler worlds, the simplest first."""
    for n in range(len(world.rules) - 1, -1, -1):
        yield replace(world, rules=world.rules[:n] + world.rules[n + 1 :])
    for n in range(len(world.inputs) - 1, -1, -1):
        later = world.inputs[n + 1 :]
        yield replace(world, inputs=world.inputs[:n] + later)
        if later:
            later = ((round(later[0][0] + world.inputs[n][0], 3), later[0][1]), *later[1:])
            yield replace(world, inputs=world.inputs[:n] + later)
    for n, rule in enumerate(world.rules):
        for simpler in smaller_rules(rule):
            yield replace(world, rules=(*world.rules[:n], simpler, *world.rules[n + 1 :]))
    for n, (seconds, op) in enumerate(world.inputs):
        if op[0] == "add":
            for simpler in smaller_rules(op[1]):
                yield replace(world, inputs=(*world.inputs[:n], (seconds, ("add", simpler)), *world.inputs[n + 1 :]))
        if seconds:
            yield replace(world, inputs=(*world.inputs[:n], (0.0, op), *world.inputs[n + 1 :]))
    for n, signal in enumerate(world.signals):
        if signal != SignalOf():
            yield replace(world, signals=(*world.signals[:n], SignalOf(), *world.signals[n + 1 :]))
            yield replace(
                world, signals=(*world.signals[:n], replace(signal, keep="all", limit=100), *world.signals[n + 1 :])
            )
    for n, slot in enumerate(world.slots):
        for plain in (
            SlotOf(always=slot.always),
            SlotOf(slot.kind),
            replace(slot, keep="all"),
            replace(slot, input=False),
        ):
            if slot != plain and slot != SlotOf():
                yield replace(world, slots=(*world.slots[:n], plain, *world.slots[n + 1 :]))
    if world.modules > 1:
        yield replace(world, modules=1)
    if world.patience != 1.0:
        yield replace(world, patience=1.0)
    if world.together:
        yield replace(world, together=False)


def smaller_rules(rule: RuleOf) -> Iterator[RuleOf]:
    plain = RuleOf(rule.when)
    for name in ("detached", "background", "thread", "weight", "cooldown", "patience", "until", "timeout"):
        if getattr(rule, name) != getattr(plain, name):
            yield replace(rule, **{name: getattr(plain, name)})
    for name in ("writes", "emits", "reads", "acts", "when", "until"):
        parts = getattr(rule, name)
        for n in range(len(parts)):
            if len(parts) > (1 if name in ("acts", "when") else 0):
                yield replace(rule, **{name: parts[:n] + parts[n + 1 :]})
    for name in ("when", "until"):
        clauses = getattr(rule, name)
        for n, clause in enumerate(clauses):
            for k, part in enumerate(clause):
                rest = clause[:k] + clause[k + 1 :]
                options = [rest] if any(isinstance(p, Want) for p in rest) else []
                if isinstance(part, Want):
                    for field, value in (("min_age", 0.0), ("max_age", 5.0), ("detached", False), ("where", "")):
                        if getattr(part, field) != value:
                            options.append((*clause[:k], replace(part, **{field: value}), *clause[k + 1 :]))
                for option in options:
                    yield replace(rule, **{name: (*clauses[:n], option, *clauses[n + 1 :])})
    for n, act in enumerate(rule.acts):
        options = [replace(act, steps=act.steps[:k] + act.steps[k + 1 :]) for k in range(len(act.steps))]
        options += [
            replace(act, steps=(*act.steps[:k], (0.0, op), *act.steps[k + 1 :]))
            for k, (after, op) in enumerate(act.steps)
            if after
        ]
        for field in ("seconds", "end", "cleanup", "last", "cancelled"):
            if getattr(act, field) != getattr(Act(), field):
                options.append(replace(act, **{field: getattr(Act(), field)}))
        for option in options:
            yield replace(rule, acts=(*rule.acts[:n], option, *rule.acts[n + 1 :]))


def keeps_to_its_word(rule: RuleOf, slots: tuple[SlotOf, ...]) -> bool:
    """Return whether a rule's function writes and emits only what the rule declares."""
    for act in rule.acts:
        for op in (*(op for _, op in act.steps), *act.last):
            if op[0] == "emit" and op[1] not in rule.emits:
                return False
            if op[0] in ("write", "store", "discard") and op[1] not in rule.writes:
                return False
            if op[0] in ("store", "discard") and slots[int(op[1][1:])].kind != "collection":
                return False
    return True


def compiles(world: World) -> bool:
    """Return whether a world's policy has no fault, and its rules write and emit only what they declare."""
    adds = [op[1] for _, op in world.inputs if op[0] == "add"]
    if not all(keeps_to_its_word(rule, world.slots) for rule in (*world.rules, *adds)):
        return False
    try:
        compiled(world)
    except (DeclarationErrors, KeyError):  # KeyError: a signal of a slot whose kind has changed
        return False
    return True


def shrink(world: World, verdict: Callable[[World], str]) -> World:
    """Return the smallest world that still gets the same verdict."""
    fault = verdict(world)
    found = True
    while found:
        found = False
        for candidate in smaller(world):
            if len(repr(candidate)) < len(repr(world)) and compiles(candidate) and verdict(candidate) == fault:
                world, found = candidate, True
                break
    return world
