"""A story that uses all features of the engine.

``python -m laws.story`` plays the story, and prints all effects and trace records."""

from __future__ import annotations

import random
from typing import Any

import ravestate as rs
from laws.short import emitter, hearer, output, resigner, writer
from scenarios.driver import Driver


def everything() -> rs.Module:
    """Return a module with rules of every kind."""
    m = rs.Module("m")
    i, j, x, y = m.signal("i", payload=str), m.signal("j"), m.signal("x"), m.signal("y")
    out, face, mood = output(m), output(m, "face"), m.slot("mood", "calm")
    people, pose = m.collection("people"), m.slot("pose", 0, keep="latest")
    emitter(m, "classify", i, x, after=0.5, only_if=lambda ctx: ctx.payload(i) == "question")
    emitter(m, "detached", i, y, detached=True)
    writer(m, "specific", x, out, cooldown=3.0, after=0.375, until=j)
    writer(m, "fused", i & j, out, after=0.25)
    writer(m, "general", i, out)
    resigner(m, "shy", i, out, weight=9.0)
    writer(m, "smile", y & j.detached(), face)
    writer(m, "gated", j & mood.holds(lambda value: value == "merry"), face)
    hearer(m, "old", i.min_age(2.0) & x & j.max_age(7.0), i, [])
    hearer(m, "meet", people.added | people.removed & j, people.added, [])
    hearer(m, "look", pose.changed & j, pose.changed, [])

    @m.rule(when=j, timeout=0.5)
    async def hang(ctx: Any) -> None:
        await ctx.sleep(1_000.0)

    @m.rule(when=y)
    async def fail(ctx: Any) -> None:
        raise ValueError(ctx.payload(y))

    @m.rule(when=j.min_age(4.0) & i)
    async def forget(ctx: Any) -> None:
        ctx.wipe(i)

    return m


def tell(sim: Any, seed: int = 7, steps: int = 40) -> None:
    """Play the story, in a random but repeatable order."""
    policy = sim.engine.policy if isinstance(sim, Driver) else sim.context.policy
    signals, slots = policy.signals, policy.slots
    dice = random.Random(seed)
    for _ in range(steps):
        match dice.randrange(7):
            case 0 | 1:
                sim.emit(signals["m:i"], dice.choice(["question", "statement"]))
            case 2 | 3:
                sim.emit(signals["m:j"])
            case 4:
                sim.put(slots["m:mood"], dice.choice(["calm", "merry"]))
            case 5:
                sim.put(slots["m:people"], {name: 1 for name in "abc" if dice.random() < 0.5})
            case _:
                sim.put(slots["m:pose"], dice.randrange(5))
        sim.advance(dice.choice([0.0, 0.125, 0.5, 1.5]))  # sums of these are exact


if __name__ == "__main__":
    with Driver(everything()) as driver:
        tell(driver)
        driver.advance(60.0)
    print(*driver.effects, *driver.trace, driver.snapshot(), sep="\n")
