"""Random worlds in which conjunctions of two signals compete: first spikes wait, and rivals come under pressure."""

from __future__ import annotations

import random
from dataclasses import replace

from properties.shrinking import compiles
from properties.worlds import Act, Op, RuleOf, SignalOf, SlotOf, Want, World


def pair_world_of(seed: int) -> World:
    """Return the world of a seed: the first random world that compiles."""
    chance = random.Random(seed)
    while not compiles(world := _world(chance)):
        pass
    return world


def _world(chance: random.Random) -> World:
    signals = [f"s{n}" for n in range(chance.randint(2, 4))]
    slots = [f"v{n}" for n in range(chance.randint(1, 2))]
    rules = [_rule(chance, signals, slots) for _ in range(chance.randint(2, 6))]
    if chance.random() < 0.25:  # each rule is the only writer of its slot
        slots = [f"v{n}" for n in range(len(rules))]
        rules = [replace(rule, writes=(slot,), cooldown=0.0) for rule, slot in zip(rules, slots, strict=True)]
    if chance.random() < 0.25:  # one pair beside a few rivals
        pair = replace(_rule(chance, ["s0", "s1"], ["v0"]), when=((Want("s0"), Want("s1")),), writes=("v0",))
        signals, slots = signals[:3], ["v0"]
        rules = [replace(rule, emits=(), acts=(_act(chance, ()),)) for rule in (pair, *rules[:2])]
        writes = ("v0",) if chance.random() < 0.7 else ()
        alike = chance.random() < 0.4  # all rules wait for pairs with the same first signal
        rules = [
            replace(rule, writes=writes, when=((Want("s0"), Want(chance.choice(signals[1:]))),) if alike else rule.when)
            for rule in rules
        ]
    most, gaps = (12, (0.0, 0.0, 0.0, 0.0, 0.3, 1.0, 1.1, 2.5)) if chance.random() < 0.7 else (24, (0.0,) * 9 + (0.4,))
    return World(
        signals=tuple(SignalOf(limit=chance.choice((100, 100, 100, 2)), input=chance.random() < 0.3) for _ in signals),
        slots=tuple(SlotOf() for _ in slots),
        rules=tuple(rules),
        inputs=tuple((chance.choice(gaps), _op(chance, signals)) for _ in range(chance.randint(most // 4, most))),
        together=chance.random() < 0.3,
        patience=chance.choice((1.0, 1.0, 0.5)),
    )


def _rule(chance: random.Random, signals: list[str], slots: list[str]) -> RuleOf:
    emits = (chance.choice(signals),) if chance.random() < 0.15 else ()
    wants = [Want(chance.choice(signals))]
    if chance.random() < 0.7:
        age = chance.choice((5.0, 5.0, 5.0, 1.5, None))
        first, second = ("s0", chance.choice(signals[1:])) if chance.random() < 0.5 else chance.sample(signals, 2)
        wants = [Want(first, max_age=age), Want(second, max_age=age, where=chance.choice(("", "", "", "odd")))]
    count = chance.choice((0, 1, 1, 1, 1, 1, 1, len(slots)))
    return RuleOf(
        when=(tuple(wants),),
        writes=tuple(chance.sample(slots, count)),
        emits=emits,
        acts=tuple(_act(chance, emits) for _ in range(chance.randint(1, 2))),
        detached=chance.random() < 0.05,
        weight=chance.choice((1.0, 1.0, 1.0, 2.0, 0.5)),
        cooldown=chance.choice((0.0, 0.0, 0.0, 0.0, 0.0, 3.0)),
        patience=chance.choice((None, None, None, 2.0, 0.0)),
    )


def _act(chance: random.Random, emits: tuple[str, ...]) -> Act:
    return Act(
        steps=tuple((0.0, ("emit", signal, 1)) for signal in emits if chance.random() < 0.5),
        seconds=chance.choice((0.0, 0.0, 0.5, 2.0)),
        end=chance.choice(("done", "done", "done", "resigned", "failed")),
    )


def _op(chance: random.Random, signals: list[str]) -> Op:
    what = chance.random()
    if what < 0.06:
        return ("wipe", chance.choice(signals))
    if what < 0.08:
        return ("add", RuleOf(when=((Want(chance.choice(signals[1:])), Want("s0")),), writes=("v0",)))
    return ("emit", chance.choice(signals), chance.randint(0, 3))
