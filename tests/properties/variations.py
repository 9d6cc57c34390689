"""Variations of random worlds: predicates that raise, several modules, rules that are added at run time."""

from __future__ import annotations

import random
from dataclasses import replace

from properties.shrinking import compiles
from properties.worlds import MODULES, Act, Clause, Gate, Op, RuleOf, Want, World


def varied(world: World, seed: int) -> World:
    """Return a world with random variations, or unchanged. Leave out a variation that does not compile."""
    chance = random.Random(f"variation {seed}")
    for variation in (_doubtful, _scattered, _extended):
        if chance.random() < 0.3 and compiles(other := variation(world, chance)):
            world = other
    return world


def _scattered(world: World, chance: random.Random) -> World:
    """Distribute a world over several modules."""
    return replace(world, modules=chance.randint(2, len(MODULES)))


def _extended(world: World, chance: random.Random) -> World:
    """Add rules at run time. Spikes of their signals can be live, or even be born in the same instant."""
    signals = [f"s{n}" for n in range(len(world.signals))]
    inputs = list(world.inputs)
    for _ in range(chance.randint(1, 2) if len(signals) > 1 else 0):
        rule = _pair(world, chance, signals) if chance.random() < 0.5 else _added(world, chance, signals)
        inputs.insert(chance.randint(0, len(inputs)), (0.0, ("add", rule)))
    return replace(world, inputs=tuple(inputs), together=world.together or chance.random() < 0.3)


def _pair(world: World, chance: random.Random, signals: list[str]) -> RuleOf:
    """Return a rule `a & b` without options."""
    return RuleOf((tuple(Want(signal) for signal in chance.sample(signals, 2)),), _slot(world, chance))


def _added(world: World, chance: random.Random, signals: list[str]) -> RuleOf:
    """Return a rule with random clauses, ages and predicates, which can raise signals."""
    emits = tuple(chance.sample(signals, chance.choice((0, 1, 1, 2))))
    clauses: list[Clause] = []
    for _ in range(chance.choice((1, 1, 1, 2))):
        wants: list[Want] = []
        for signal in chance.sample(signals, chance.choice((1, 1, 2))):
            low = chance.choice((0.0, 0.0, 0.0, 0.5, 1.0))
            where = chance.choice(("", "", "", "odd", "never"))
            wants.append(Want(signal, low, chance.choice((5.0, 5.0, 1.5, None)), chance.random() < 0.1, where))
        clauses.append(tuple(wants))
    steps = tuple((chance.choice((0.0, 0.0, 0.5)), ("emit", name, chance.randint(0, 2))) for name in emits)
    acts = (Act(steps[: chance.randint(0, len(steps))], chance.choice((0.0, 0.0, 1.0))),)
    return RuleOf(tuple(clauses), _slot(world, chance), emits, acts, detached=chance.random() < 0.1)


def _slot(world: World, chance: random.Random) -> tuple[str, ...]:
    """Return the slot that an added rule writes, or none."""
    return (f"v{chance.randrange(len(world.slots))}",) if world.slots and chance.random() < 0.4 else ()


def _doubtful(world: World, chance: random.Random) -> World:
    """Give conditions predicates that can raise an error."""

    def condition(clauses: tuple[Clause, ...]) -> tuple[Clause, ...]:
        return tuple(tuple(part(one) for one in clause) for clause in clauses)

    def part(one: Want | Gate) -> Want | Gate:
        if chance.random() >= 0.3:
            return one
        if isinstance(one, Gate):
            return replace(one, predicate=chance.choice(("fussy", "choosy")))
        return replace(one, where=chance.choice(("fussy", "choosy", "odd fussy", "fussy choosy")))

    def rule(one: RuleOf) -> RuleOf:
        return replace(one, when=condition(one.when), until=condition(one.until))

    def op(one: Op) -> Op:
        return ("add", rule(one[1])) if one[0] == "add" else one

    rules = tuple(rule(one) for one in world.rules)
    return replace(world, rules=rules, inputs=tuple((seconds, op(one)) for seconds, one in world.inputs))
