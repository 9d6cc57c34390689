"""What does ten times as much work cost?

Each workload runs on the bare engine. Its rules do nothing, or only raise a signal. It runs at one size and at ten times that size:

- Pairs: n spikes of each of two signals, for a rule `a & b`. The rule writes nothing, or it writes a slot.
- Halves: for a rule `a & b`, n spikes of `a` wait for a spike of `b`. At the end, a single spike of `b` comes.
- Topics: an input among n rules `input & topic_i`. The topics are inputs, or a classifier raises them.
- Fallbacks: an input among n rules `input & topic_i` and n rules on the input alone.
- Stalemates: n inputs, each of which makes two pairs of rules wait for each other.
- Burst: n spikes at once, for one rule. The rule writes nothing, or it writes a slot.
- Pairs beside a fallback, or beside another pair: as pairs, but another rule writes the same slot.
- Shared half: n spikes of each of two signals for a rule `a & b`. A second rule `a & c` also takes the spikes of `a`.
- Recovering and guarded fallbacks: an input among n fallbacks with a cooldown, or with a predicate on a slot.
- Independent writers: an input among n rules, each with a slot of its own.
- Cliques: an input among rules `input & topic_i`. Rules raise each topic from each other topic (n links in all), and no
  topic occurs.

Ten times as many spikes, rules or links may take about ten times the time.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare
from benchmarks.peers.wire import serve
from ravestate.engine.effects import Run
from ravestate.engine.engine import Engine
from ravestate.engine.events import Emit, Event, Finish

SPIKES, RULES = 50, 100
FACTOR = 10
LINEAR = 13.0
"""The maximum factor by which the time may grow at ten times the size."""
LIMIT = 1_000_000


def declare(module: rs.Module, name: str, **options: object) -> None:
    """Declare a rule whose function nobody calls."""

    async def function(ctx: rs.RuleContext) -> None:
        """Do nothing."""

    module.rule(name=name, **options)(function)  # type: ignore[arg-type]


def play(engine: Engine, given: Sequence[Event], emits: Mapping[str, str] | None = None, now: float = 0.0) -> int:
    """Receive events and run rules until nothing is left to do; return the number of runs.

    `emits` maps the name of a rule to the signal that the rule raises.
    """
    runs = 0
    for event in given:
        engine.receive(event, now)
    while effects := engine.effects():
        for effect in effects:
            if isinstance(effect, Run):
                runs += 1
                if emits and effect.rule.name in emits:
                    engine.receive(Emit(emits[effect.rule.name], None, effect.run), now)
                engine.receive(Finish(effect.run, "done"), now)
    return runs


def pairs(size: int, *, writes: bool) -> float:
    m = rs.Module("m")
    a, b, out = m.signal("a", limit=LIMIT), m.signal("b", limit=LIMIT), m.slot("out", "")
    declare(m, "both", when=a & b, writes=out if writes else ())
    engine = Engine(rs.compile(m))
    given = [*(Emit("m:a", n) for n in range(size)), *(Emit("m:b", n) for n in range(size))]
    begin = time.process_time()
    assert play(engine, given) == size
    return time.process_time() - begin


def halves(size: int) -> float:
    m = rs.Module("m")
    a, b = m.signal("a", limit=LIMIT), m.signal("b")
    declare(m, "both", when=a & b)
    engine = Engine(rs.compile(m))
    begin = time.process_time()
    assert play(engine, [Emit("m:a", n) for n in range(size)]) == 0
    assert play(engine, [Emit("m:b")]) == 1
    return time.process_time() - begin


def topics(size: int, *, raised: bool, fallbacks: int = 1) -> float:
    m = rs.Module("m")
    heard, out = m.signal("heard"), m.slot("out", "")
    about = [m.signal(f"topic{n}") for n in range(size)]
    if raised:
        declare(m, "classifier", when=heard, emits=about)
    for n, topic in enumerate(about):
        declare(m, f"about{n}", when=heard & topic, writes=out)
    for n in range(fallbacks):
        declare(m, f"fallback{n}", when=heard, writes=out)
    engine = Engine(rs.compile(m))
    topic = about[size // 2].name
    times: list[float] = []
    for n in range(5):
        now = 10.0 * n
        given: list[Event] = [Emit("m:heard")] if raised else [Emit("m:heard"), Emit(topic)]
        begin = time.process_time()
        runs = play(engine, given, {"m:classifier": topic} if raised else None, now)
        while (due := engine.next_deadline()) is not None:
            engine.advance(due)
            runs += play(engine, (), None, due)
        times.append(time.process_time() - begin)
        assert runs == 1 + raised, runs
    return min(times)


def stalemates(size: int) -> float:
    m = rs.Module("m")
    go, x, y = m.signal("go", limit=LIMIT), m.signal("x"), m.signal("y")
    one, other = m.slot("one", ""), m.slot("other", "")
    declare(m, "raises_x", when=go, writes=one, emits=x)
    declare(m, "raises_y", when=go, writes=other, emits=y)
    declare(m, "wants_y", when=go & y, writes=one)
    declare(m, "wants_x", when=go & x, writes=other)
    engine = Engine(rs.compile(m))
    begin = time.process_time()
    assert play(engine, [Emit("m:go", n) for n in range(size)]) == 2 * size
    return time.process_time() - begin


def burst(size: int, *, writes: bool) -> float:
    m = rs.Module("m")
    ping, out = m.signal("ping", limit=LIMIT), m.slot("out", "")
    declare(m, "handle", when=ping, writes=out if writes else ())
    engine = Engine(rs.compile(m))
    begin = time.process_time()
    assert play(engine, [Emit("m:ping", n) for n in range(size)]) == size
    return time.process_time() - begin


def timed(engine: Engine, given: Sequence[Event], expected: int, until: float = 0.0) -> float:
    """Return the seconds of processor time from events to their runs. The time includes the deadlines up to `until`
    (seconds)."""
    begin = time.process_time()
    runs = play(engine, given)
    while (due := engine.next_deadline()) is not None and due <= until:
        engine.advance(due)
        runs += play(engine, (), None, due)
    assert runs == expected, runs
    return time.process_time() - begin


def rival_pairs(size: int, *, shared: bool) -> float:
    m = rs.Module("m")
    a, b, c, out = m.signal("a", limit=LIMIT), m.signal("b", limit=LIMIT), m.signal("c"), m.slot("out", "")
    declare(m, "both", when=a & b, writes=out)
    declare(m, "rival", when=a & c if shared else a, writes=out)
    given = [*(Emit("m:a", n) for n in range(size)), *(Emit("m:b", n) for n in range(size))]
    return timed(Engine(rs.compile(m)), given, size)


def shared_half(size: int) -> float:
    m = rs.Module("m")
    a, b, c = m.signal("a", limit=LIMIT), m.signal("b", limit=LIMIT), m.signal("c")
    declare(m, "one", when=a & b)
    declare(m, "other", when=a & c)
    given = [*(Emit("m:a", n) for n in range(size)), *(Emit("m:b", n) for n in range(size))]
    return timed(Engine(rs.compile(m)), given, size)


def fallbacks(size: int, *, guarded: bool) -> float:
    m = rs.Module("m")
    heard, out, calm = m.signal("heard"), m.slot("out", ""), m.flag("calm", default=True)
    declare(m, "topic", when=heard & m.signal("topic"), writes=out)
    for n in range(size):
        if guarded:
            declare(m, f"fallback{n}", when=heard & calm.holds(bool), writes=out)
        else:
            declare(m, f"fallback{n}", when=heard, writes=out, cooldown=20.0)
    return timed(Engine(rs.compile(m)), [Emit("m:heard")], 1, until=1.0)


def independent(size: int) -> float:
    m = rs.Module("m")
    heard = m.signal("heard")
    for n in range(size):
        declare(m, f"rule{n}", when=heard, writes=m.slot(f"out{n}", ""))
    return timed(Engine(rs.compile(m)), [Emit("m:heard")], size)


def cliques(links: int) -> float:
    m = rs.Module("m")
    heard, out = m.signal("heard"), m.slot("out", "")
    topics = [m.signal(f"topic{n}") for n in range(round((links + 0.25) ** 0.5 + 0.5))]
    declare(m, "begins", when=heard & m.signal("hint"), emits=topics[0])
    for n, topic in enumerate(topics):
        declare(m, f"leads{n}", when=topic, emits=[other for other in topics if other is not topic])
        declare(m, f"about{n}", when=heard & topic, writes=out)
    declare(m, "fallback", when=heard, writes=out)
    return timed(Engine(rs.compile(m)), [Emit("m:heard")], 1, until=1.0)


WORKLOADS: dict[str, tuple[int, Callable[[int], float]]] = {
    "pairs": (SPIKES, partial(pairs, writes=False)),
    "pairs that write": (SPIKES, partial(pairs, writes=True)),
    "halves": (SPIKES, halves),
    "stalemates": (SPIKES, stalemates),
    "burst": (1_000, partial(burst, writes=False)),
    "burst that writes": (1_000, partial(burst, writes=True)),
    "topics, inputs": (RULES, partial(topics, raised=False)),
    "topics, raised": (RULES, partial(topics, raised=True)),
    "fallbacks": (RULES, lambda size: topics(size, raised=True, fallbacks=size)),
    "pairs beside a fallback": (SPIKES, partial(rival_pairs, shared=False)),
    "pairs beside another pair": (SPIKES, partial(rival_pairs, shared=True)),
    "shared half": (5 * SPIKES, shared_half),
    "recovering fallbacks": (RULES, partial(fallbacks, guarded=False)),
    "guarded fallbacks": (RULES, partial(fallbacks, guarded=True)),
    "independent writers": (RULES, independent),
    "cliques": (90, cliques),
}
"""For each workload: its smaller size, and a function that returns the seconds of processor time at a given size."""


def grow(workload: str, size: int) -> float:
    """Return the seconds of processor time of a workload at a size.

    Earlier workloads leave thousands of dead records of policies. Collect these first, or their removal (up to 50 ms)
    would add to the time of a later workload.
    """
    gc.collect()
    return WORKLOADS[workload][1](size)


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare each workload with itself at a tenth of the size."""
    ours = bench.ours("benchmarks.questions.growing")
    few: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    many: dict[str, list[float]] = {name: [] for name in WORKLOADS}
    for _ in bench.rounds(5, 2):
        for name, (size, _) in WORKLOADS.items():
            few[name].append(min(ours.ask("grow", workload=name, size=size) for _ in range(5)))
            many[name].append(ours.ask("grow", workload=name, size=FACTOR * size))
    for name, (size, _) in WORKLOADS.items():
        title = f"{name}: {FACTOR * size:,}"
        yield compare(
            "growing", title, many[name], f"{size:,}", few[name], target="<= 13", reach=lambda ratio: ratio <= LINEAR
        )


if __name__ == "__main__":
    serve(grow)
