"""Random worlds from a seed, played on the engine and on the interpreter of the laws (``laws/model.py``).

``python -m properties.fuzz [COUNT] [FIRST]`` plays fresh seeds, or those from FIRST, and prints the smallest world that it
finds for each difference.
"""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from laws.model import Model
from properties.worlds import Act, Counted, Endless, Gate, Op, Play, RuleOf, SignalOf, SlotOf, Want, World, compiled
from ravestate.declare.core import RuleFailure
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run
from ravestate.errors import DeclarationErrors

BIRTHS = 2_000
MOMENTS = 300
"""Moments of a play that are compared."""

STEPS = 3_000
"""Steps of derivations after which the interpreter, which has no cache, leaves a play."""


ENOUGH = "too long to go on"


class Enough(Exception):
    """The rest of a play would take the interpreter too long."""


class Interpreter(Model):
    """The interpreter; it notices when an instant has no end."""

    births = 0

    def effects(self) -> list[Effect]:
        if self.steps > STEPS:
            raise Enough
        return super().effects()

    def birth(self, *args: Any) -> None:
        self.births += 1
        if self.births > BIRTHS:
            raise Endless(f"more than {BIRTHS} spikes at {self.now} s")
        super().birth(*args)


# ------------------------------------------------------------------------------------ the worlds


class Maker:
    """Makes the parts of a world from random numbers."""

    def __init__(self, seed: int) -> None:
        self.dice = random.Random(seed)
        self.grid = self.dice.random() < 0.4  # many things at one time, or all at different times
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
        own = {"value": ("changed",), "flag": ("changed", "true", "false"), "collection": ("changed", "added", "removed")}
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
        if self.chance(0.5):
            return Want(signal)
        low = self.seconds(2.0) if self.chance(0.5) else 0.0
        high = None if self.chance(0.3) and not signal.startswith("core:") else max(low, self.dice.choice([5.0, 5.0, 1.0]))
        where = self.dice.choice(["odd", "odd", "odd", "never"]) if self.chance(0.2) else ""
        detached = self.chance(0.25)
        if detached and high == low:
            high += 1.0  # else it can be looked at for no time at all
        return Want(signal, low, high, detached, where)

    def condition(self, heard: list[str]) -> tuple[Any, ...]:
        clauses: list[tuple[Any, ...]] = []
        for _ in range(2 if self.chance(0.2) else 1):
            parts: list[Any] = [self.want(heard) for _ in range(self.dice.choice([1, 1, 1, 2, 2, 3]))]
            if self.chance(0.12):
                parts.append(Gate(f"v{self.dice.randrange(len(self.slots))}", self.dice.choice(["odd", "odd", "never"])))
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
        steps: list[tuple[float, Op]] = []
        for _ in range(dice.choice([0, 1, 1, 2, 3])):
            steps.append((0.0 if self.chance(0.6) else self.seconds(2.0), self.step(ops)))
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


# ------------------------------------------------------------------------------------ the comparison


def story(world: World, machine: Any) -> list[str]:
    """Play a world; return what a machine did, a line for each effect."""
    lines: list[str] = []
    numbers: dict[int, int] = {}

    def told(play: Play, effect: Effect) -> None:
        line = f"{play.now:10.6f} "
        match effect:
            case Run():
                run = play.engine.running[effect.run]
                numbers[effect.run] = len(numbers)
                needs = run.clause.needs
                held = run.held if isinstance(play.engine, Model) else run.spikes
                spikes = [f"{n.signal.name}={shown(held[n.index].payload)}@{held[n.index].born:g}" for n in needs]
                values = sorted((name, dict(v) if hasattr(v, "keys") else v) for name, v in effect.values.items())
                line += f"run {effect.rule.name}[{run.clause.number}] on {' '.join(spikes)}, reading {values}"
            case Ended():
                line += f"end of run {numbers[effect.run]} of {effect.rule}: {effect.outcome} {effect.fired}"
            case Cancel():
                line += f"cancel run {numbers[effect.run]}: {effect.reason}"
            case Failed():
                line += f"failure of {effect.rule}: {type(effect.exception).__name__}"
            case _:
                line += repr(effect)
        lines.append(line)

    play = Play(world, started=told, machine=machine, budget=4)
    try:
        for _ in range(MOMENTS):
            if not play.step():
                break
    except Endless as endless:
        lines.append(f"endless: {endless}")
    except Enough:
        lines.append(ENOUGH)
    return lines


def shown(payload: Any) -> str:
    """Return a payload as text; a failure without its wording."""
    if isinstance(payload, RuleFailure):
        return f"{payload.rule}: {type(payload.exception).__name__}"
    return repr(payload)


def difference(world: World) -> str:
    """Return where the engine departs from the laws, in words; an empty text if it does not."""
    laws, engine = story(world, Interpreter), story(world, Counted)
    for number in range(max(len(laws), len(engine))):
        one = laws[number] if number < len(laws) else "nothing more"
        other = engine[number] if number < len(engine) else "nothing more"
        if one == ENOUGH:
            break
        if one != other:
            before = "\n".join(laws[:number])
            return f"{before}\n  laws:   {one}\n  engine: {other}"
    return ""


def verdict(world: World) -> str:
    """Return whether the engine keeps to the laws: an empty text, ``differs``, or the name of an exception."""
    try:
        return "differs" if difference(world) else ""
    except Exception as exception:
        return repr(exception)


# ------------------------------------------------------------------------------------ shrinking


def smaller(world: World) -> Iterator[World]:
    """Yield simpler worlds, the much simpler ones first."""
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
        for plain in (SlotOf(always=slot.always), SlotOf(slot.kind), replace(slot, keep="all"), replace(slot, input=False)):
            if slot != plain and slot != SlotOf():
                yield replace(world, slots=(*world.slots[:n], plain, *world.slots[n + 1 :]))
    if world.patience != 1.0:
        yield replace(world, patience=1.0)
    if world.together:
        yield replace(world, together=False)


def smaller_rules(rule: RuleOf) -> Iterator[RuleOf]:
    plain = RuleOf(rule.when)
    for name in ("detached", "background", "thread", "weight", "cooldown", "patience", "until", "timeout"):
        if getattr(rule, name) != getattr(plain, name):
            yield replace(rule, **{name: getattr(plain, name)})
    for name in ("writes", "emits", "acts", "when", "until"):
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
    """Return whether a world's policy has no fault, and its rules do what they declare."""
    adds = [op[1] for _, op in world.inputs if op[0] == "add"]
    if not all(keeps_to_its_word(rule, world.slots) for rule in (*world.rules, *adds)):
        return False
    try:
        compiled(world)
    except (DeclarationErrors, KeyError):  # KeyError: the signal of a slot that has become one of another kind
        return False
    return True


def shrink(world: World) -> World:
    """Return the smallest world that still shows the same fault."""
    fault = verdict(world)
    found = True
    while found:
        found = False
        for candidate in smaller(world):
            if len(repr(candidate)) < len(repr(world)) and compiles(candidate) and verdict(candidate) == fault:
                world, found = candidate, True
                break
    return world


def main(count: int, first: int, most: int = 1) -> int:
    """Play `count` seeds; stop after `most` differences. Return how many there were."""
    faults: list[int] = []
    start = time.process_time()
    for seed in range(first, first + count):
        world = world_of(seed)
        fault = verdict(world)
        if fault:
            print(f"seed {seed}: {fault}", flush=True)
            faults.append(seed)
            if len(faults) <= most:
                least = shrink(world)
                try:
                    words = difference(least)
                except Exception as exception:
                    words = f"breaks: {exception!r}"
                print(f"seed {seed}: {least!r}\n{words}\n", flush=True)
    print(f"{count} seeds from {first}: {len(faults)} differences {faults[:20]}, {time.process_time() - start:.1f} s of CPU")
    return len(faults)


if __name__ == "__main__":
    arguments = [int(argument) for argument in sys.argv[1:]]
    begin = arguments[1] if len(arguments) > 1 else random.SystemRandom().randrange(10**9)
    sys.exit(min(1, main(arguments[0] if arguments else 20_000, begin, arguments[2] if len(arguments) > 2 else 1)))
