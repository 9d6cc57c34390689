"""Random worlds from a seed. Making one is much faster than an example of Hypothesis, so a test can play thousands."""

from __future__ import annotations

import random
from typing import Any

from properties.worlds import Act, Gate, Op, RuleOf, SignalOf, SlotOf, Want, World, compiled
from ravestate.errors import DeclarationErrors


class Maker:
    """Makes the parts of a world from random numbers."""

    def __init__(self, seed: int) -> None:
        self.dice = random.Random(seed)
        self.plain = seed // 100 % 4 == 3  # conditions without ages or predicates
        self.grid = self.dice.random() < 0.4  # if true, many events come at the same time
        self.signals: list[str] = []
        self.heard: list[str] = []
        self.slots: list[SlotOf] = []

    def chance(self, share: float) -> bool:
        return self.dice.random() < share

    def seconds(self, most: float) -> float:
        if self.grid:
            return self.dice.choice([0.0, 0.25, 0.5, 1.0, 2.0, 5.0][: 2 + int(most)])
        return round(self.dice.random() * most, 3)

    def pick(self, options: list[Any], most: int) -> tuple[Any, ...]:
        count = min(len(options), self.dice.choice([0, 1, 1, 1, 2][: most + 3]))
        return tuple(self.dice.sample(options, count))

    def world(self) -> World:
        dice = self.dice
        signals = tuple(
            SignalOf(
                keep="latest" if self.chance(0.08) else "all",
                limit=dice.choice([1, 2]) if self.chance(0.06) else 100,
                input=self.chance(0.3),
            )
            for _ in range(dice.randint(1, 4))
        )
        self.slots = [
            SlotOf(
                kind=dice.choice(["value", "value", "value", "flag", "collection"]),
                always=self.chance(0.6),
                keep="latest" if self.chance(0.08) else "all",
                input=self.chance(0.2),
            )
            for _ in range(dice.randint(1, 3))
        ]
        self.signals = [f"s{number}" for number in range(len(signals))]
        own = {
            "value": ("changed",),
            "flag": ("changed", "true", "false"),
            "collection": ("changed", "added", "removed"),
        }
        self.heard = self.signals * dice.choice([1, 2, 4])
        self.heard += [f"v{n}:{what}" for n, slot in enumerate(self.slots) for what in own[slot.kind]]
        rules = tuple(self.rule() for _ in range(dice.randint(2, 6)))
        inputs = tuple((self.gap(), self.input()) for _ in range(dice.randint(3, 9)))
        return World(
            signals, tuple(self.slots), rules, inputs, dice.choice([1.0, 1.0, 0.25, 2.0]), together=self.chance(0.3)
        )

    def gap(self) -> float:
        if self.chance(0.35):
            return 0.0
        return self.seconds(1.0) if self.chance(0.7) else self.seconds(4.0)

    def input(self) -> Op:
        if self.chance(0.7):
            return ("emit", self.dice.choice(self.signals), self.dice.choice([0, 1, 2]))
        if self.chance(0.1):
            return ("wipe", self.dice.choice(self.heard))
        if self.chance(0.08):
            return ("start",)
        if self.chance(0.1):
            return ("add", self.rule())
        return self.write(self.dice.randrange(len(self.slots)))

    def write(self, number: int) -> Op:
        dice, name = self.dice, f"v{number}"
        match self.slots[number].kind:
            case "value":
                return ("write", name, dice.choice([0, 1, 2]))
            case "flag":
                return ("write", name, self.chance(0.5))
            case _ if self.chance(0.2):
                return ("write", name, dice.choice([(), (("a", 1),), (("b", 1), ("a", 2))]))
            case _ if self.chance(0.3):
                return ("discard", name, dice.choice("ab"))
            case _:
                return ("store", name, dice.choice("ab"), dice.choice([0, 1, 2]))

    def want(self, heard: list[str]) -> Want:
        signal = self.dice.choice(heard)
        if self.plain:
            return Want(signal, max_age=self.dice.choice([5.0, 1.0, None]))
        if self.chance(0.5):
            return Want(signal)
        low = self.seconds(2.0) if self.chance(0.5) else 0.0
        high = (
            None if self.chance(0.3) and not signal.startswith("core:") else max(low, self.dice.choice([5.0, 5.0, 1.0]))
        )
        where = self.dice.choice(["odd", "odd", "odd", "never"]) if self.chance(0.2) else ""
        detached = self.chance(0.25)
        if detached and high == low:
            high += 1.0  # otherwise, the constraint could hold a spike only for an instant
        return Want(signal, low, high, detached, where)

    def condition(self, heard: list[str]) -> tuple[Any, ...]:
        clauses: list[tuple[Any, ...]] = []
        for _ in range(2 if self.chance(0.2) else 1):
            parts: list[Any] = [
                self.want(heard) for _ in range(self.dice.choice([1, 2, 2] if self.plain else [1, 1, 1, 2, 2, 3]))
            ]
            if self.chance(0.12):
                parts.append(
                    Gate(f"v{self.dice.randrange(len(self.slots))}", self.dice.choice(["odd", "odd", "never"]))
                )
            clauses.append(tuple(parts))
        return tuple(clauses)

    def rule(self) -> RuleOf:
        dice = self.dice
        heard, background = self.heard, self.chance(0.15)
        if self.chance(0.1):
            flags = ["core:activity:true", "core:activity:false", "core:pressure:true", "core:pressure:false"]
            heard, background = [*self.heard, *flags, "core:error", "core:startup"], True
        writes = self.pick([f"v{number}" for number in range(len(self.slots))], 2)
        emits = self.pick(self.signals, 2)
        ops = [*(("emit", name) for name in emits), *(("write", name) for name in writes)]
        return RuleOf(
            self.condition(heard),
            writes,
            emits,
            tuple(self.act(ops) for _ in range(dice.choice([1, 1, 2]))),
            detached=self.chance(0.2),
            background=background,
            thread=self.chance(0.1),
            weight=dice.choice([1.0, 1.0, 1.0, 2.0, 0.5]),
            cooldown=dice.choice([2.0, 5.0, 20.0]) if self.chance(0.2) else 0.0,
            patience=dice.choice([0.0, 0.5, 3.0]) if self.chance(0.2) else None,
            until=self.condition(self.heard) if self.chance(0.12) else (),
            timeout=dice.choice([0.5, 1.0]) if self.chance(0.12) else None,
        )

    def act(self, ops: list[tuple[str, str]]) -> Act:
        dice = self.dice
        count = dice.choice([0, 1, 1, 2, 3])
        steps = [(0.0 if self.chance(0.6) else self.seconds(2.0), self.step(ops)) for _ in range(count)]
        return Act(
            tuple((after, op) for after, op in steps if op),
            0.0 if self.chance(0.6) else self.seconds(2.0),
            dice.choice(["resigned", "failed", "retired"]) if self.chance(0.25) else "done",
            self.seconds(1.0) if self.chance(0.2) else 0.0,
            tuple(filter(None, [self.step(ops)])) if self.chance(0.2) else (),
            dice.choice(["resigned", "failed", "retired"]) if self.chance(0.2) else "done",
        )

    def step(self, ops: list[tuple[str, str]]) -> Op:
        if self.chance(0.04):
            return ("wipe", self.dice.choice(self.heard))
        if not ops:
            return ()
        kind, name = self.dice.choice(ops)
        return ("emit", name, self.dice.choice([0, 1, 2])) if kind == "emit" else self.write(int(name[1:]))


def world_of(seed: int) -> World:
    """Return the world of a seed: the first of its attempts that compiles."""
    for attempt in range(100):
        world = Maker(seed * 100 + attempt).world()
        try:
            compiled(world)
        except DeclarationErrors:
            continue
        return world
    raise AssertionError(seed)
