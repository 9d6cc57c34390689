"""Workloads whose costs must not grow faster than their size, and a count of the engine's steps for each workload.

Each line of the engine that runs is a step. A list of a causal group's members counts one step for each member, because
a single line makes the whole list. Steps can only be counted in pure Python, so ``test_growth.py`` runs this file in a
separate process.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from functools import partial
from types import FrameType
from typing import Any

import ravestate as rs
from engine.test_halves import declared, runs
from ravestate.engine.activation import Activation
from ravestate.engine.engine import Engine
from ravestate.engine.events import Emit
from ravestate.engine.group import Group

FEW, MANY = 50, 500
ENGINE = "/ravestate/engine/"

Work = Callable[[], None]


def independent_writers(size: int) -> Work:
    """Make rules that all react to one input. Each writes its own slot."""
    m = rs.Module("m")
    heard = m.signal("heard")
    for n in range(size):
        declared(m, f"rule{n}", when=heard, writes=m.slot(f"out{n}", ""))
    engine = Engine(rs.compile(m))

    def work() -> None:
        assert len(runs(engine, Emit("m:heard"))) == size

    return work


def fallbacks(size: int, *, cooldown: float = 0.0, guarded: bool = False) -> Work:
    """Make fallbacks that wait for a topic. With `cooldown`, a rule that has answered must recover."""
    m = rs.Module("m")
    heard, out, calm = m.signal("heard"), m.slot("out", ""), m.flag("calm", default=True)
    declared(m, "topic", when=heard & m.signal("topic"), writes=out)
    when = heard & calm.holds(bool) if guarded else heard
    for n in range(size):
        declared(m, f"fallback{n}", when=when, writes=out, cooldown=cooldown)
    engine = Engine(rs.compile(m))

    def work() -> None:
        for now in (0.0, 3.0):
            assert not runs(engine, Emit("m:heard"), now=now)
            engine.advance(now + 1.0)
            assert len(runs(engine, now=now + 1.0)) == 1

    return work


def pairs(size: int, rival: str, **options: Any) -> Work:
    """Make a rule `a & b`, and another writer of its slot. All spikes come together."""
    m = rs.Module("m")
    a, b, c, out = m.signal("a", limit=9999), m.signal("b", limit=9999), m.signal("c"), m.slot("out", "")
    declared(m, "both", when=a & b, writes=out)
    declared(m, "other", when={"a": a, "b": b, "c": c, "a & c": a & c}[rival], writes=out, **options)
    engine = Engine(rs.compile(m))
    given = [*(Emit("m:a", n) for n in range(size)), *(Emit("m:b", n) for n in range(size))]

    def work() -> None:
        assert len(runs(engine, *given)) == size

    return work


def shared_half(size: int) -> Work:
    """Make two rules that share their first spikes. The second spikes all fit the same rule."""
    m = rs.Module("m")
    a, b, c = m.signal("a", limit=9999), m.signal("b", limit=9999), m.signal("c")
    declared(m, "one", when=a & b)
    declared(m, "other", when=a & c)
    engine = Engine(rs.compile(m))
    given = [*(Emit("m:a", n) for n in range(size)), *(Emit("m:b", n) for n in range(size))]

    def work() -> None:
        assert len(runs(engine, *given)) == size

    return work


WORKLOADS: dict[str, Callable[[int], Work]] = {
    "independent writers": independent_writers,
    "recovering fallbacks": partial(fallbacks, cooldown=20.0),
    "guarded fallbacks": partial(fallbacks, guarded=True),
    "pairs beside a fallback": partial(pairs, rival="a"),
    "pairs beside a fallback for their second spike": partial(pairs, rival="b"),
    "pairs beside a recovering fallback": partial(pairs, rival="a", cooldown=5.0),
    "pairs beside a writer of another cause": partial(pairs, rival="c", weight=5.0),
    "pairs that share a half": shared_half,
    "pairs beside another pair": partial(pairs, rival="a & c"),
}


def steps(work: Work) -> int:
    """Return how many steps of the engine a piece of work takes."""
    count = 0

    def members(group: Group) -> tuple[Activation, ...]:
        nonlocal count
        found = listed.fget(group)
        count += len(found)
        return found

    def trace(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal count
        if ENGINE not in frame.f_code.co_filename:
            return None
        count += event == "line"
        return trace

    listed: Any = Group.members
    setattr(Group, "members", property(members))  # noqa: B010  # it has no other setter
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(None)
        setattr(Group, "members", listed)  # noqa: B010
    return count


if __name__ == "__main__":
    print(json.dumps({name: [steps(make(size)) for size in (FEW, MANY)] for name, make in WORKLOADS.items()}))
