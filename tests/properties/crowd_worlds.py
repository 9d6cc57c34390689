"""Random worlds in which many rules react to one input, with slot predicates, cooldowns and cycles of topics."""

from __future__ import annotations

import random

from properties.shrinking import compiles
from properties.worlds import Act, Clause, Gate, Op, RuleOf, SignalOf, SlotOf, Want, World


def crowd_world_of(seed: int) -> World:
    """Return the world of a seed: the first random world that compiles."""
    chance = random.Random(f"crowd {seed}")
    while not compiles(world := _world(chance)):
        pass
    return world


def _world(chance: random.Random) -> World:
    topics = [f"s{n}" for n in range(1, chance.randint(2, 5))]
    slots = [f"v{n}" for n in range(chance.randint(1, 3))]
    dense = chance.random() < 0.5  # many rules raise topics, so topics lead to each other
    alike = chance.random() < 0.5  # most rules write the same slots
    common = tuple(chance.sample(slots, chance.choice((1, 1, len(slots)))))
    rules: list[RuleOf] = []
    for _ in range(chance.randint(3, 8)):
        emits: tuple[str, ...] = ()
        if chance.random() < (0.5 if dense else 0.15):
            emits = tuple(chance.sample(topics, chance.randint(1, len(topics))))
        some = tuple(chance.sample(slots, chance.choice((0, 1, 1, 1, len(slots)))))
        writes = common if alike and chance.random() < 0.7 else some
        rules.append(
            RuleOf(
                when=_condition(chance, topics, slots),
                writes=writes,
                emits=emits,
                acts=tuple(_act(chance, emits, writes) for _ in range(chance.randint(1, 2))),
                reads=tuple(chance.sample(slots, 1)) if chance.random() < 0.15 else (),
                detached=chance.random() < 0.05,
                weight=chance.choice((1.0, 1.0, 1.0, 2.0, 0.5)),
                cooldown=chance.choice((0.0, 0.0, 2.0, 3.0)),
                patience=chance.choice((None, None, None, 2.0, 0.0)),
            )
        )
    return World(
        signals=tuple(SignalOf(input=not n or chance.random() < 0.5) for n in range(len(topics) + 1)),
        slots=tuple(SlotOf() for _ in slots),
        rules=tuple(rules),
        inputs=tuple((chance.choice((0.0, 0.0, 0.3, 1.0, 1.1, 2.5)), _op(chance, topics, slots)) for _ in range(8)),
        together=chance.random() < 0.4,
        patience=chance.choice((1.0, 1.0, 0.5)),
    )


def _condition(chance: random.Random, topics: list[str], slots: list[str]) -> tuple[Clause, ...]:
    clauses: list[Clause] = []
    for _ in range(chance.choice((1, 1, 1, 1, 2))):
        where = chance.choice(("", "", "", "odd"))
        parts: list[Want | Gate] = [Want("s0", where=where)]
        kind = chance.random()
        if kind < 0.4:
            parts.append(Want(chance.choice(topics)))
        elif kind < 0.6:
            parts = [Want(topic) for topic in chance.sample(topics, chance.randint(1, min(2, len(topics))))]
        if chance.random() < 0.3:
            parts.append(Gate(chance.choice(slots), chance.choice(("odd", "odd", "never"))))
        clauses.append(tuple(parts))
    return tuple(clauses)


def _act(chance: random.Random, emits: tuple[str, ...], writes: tuple[str, ...]) -> Act:
    steps: list[tuple[float, Op]] = [
        (0.0, ("emit", one, chance.randint(0, 2))) for one in emits if chance.random() < 0.4
    ]
    steps += [(0.0, ("write", slot, chance.randint(0, 2))) for slot in writes if chance.random() < 0.4]
    return Act(
        steps=tuple(steps),
        seconds=chance.choice((0.0, 0.0, 0.5, 2.0)),
        end=chance.choice(("done", "done", "done", "resigned", "failed")),
    )


def _op(chance: random.Random, topics: list[str], slots: list[str]) -> Op:
    what = chance.random()
    if what < 0.05:
        return ("wipe", chance.choice(topics))
    if what < 0.07:
        return ("stop",)
    if what < 0.2:
        return ("write", chance.choice(slots), chance.randint(0, 2))
    return ("emit", "s0" if chance.random() < 0.6 else chance.choice(topics), chance.randint(0, 2))
