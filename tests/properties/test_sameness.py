"""Random worlds: observers, repetitions and unnecessary calls change nothing (laws L24, L25).

`test_same_as_the_laws.py` has the tests about tracers and journals.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import ravestate
from properties.oracle import still
from properties.strategies import worlds
from properties.worlds import Play, RuleOf, Want, World, rule_of
from ravestate.engine.events import AddRule

TESTS = Path(__file__).parents[1]
SOURCES = Path(ravestate.__file__).parents[1]


@given(worlds(), st.lists(st.sampled_from([0.0, 0.1, 0.5, 0.9, 0.999]), min_size=1, max_size=3).map(sorted))
def test_a_spurious_advance_changes_nothing(world: World, parts: list[float]) -> None:
    def disturb(play: Play) -> None:
        engine = play.engine
        due = play.next_time()
        assert due is not None
        before = still(play)
        for part in parts:
            engine.advance(play.now + part * (due - play.now))
            assert engine.effects() == []
            assert still(play) == before
        engine.advance(engine.now)
        assert engine.effects() == []
        assert still(play) == before

    assert Play(world, before=disturb).play().heard == Play(world).play().heard


@given(worlds())
def test_a_snapshot_does_not_change_what_happens_next(world: World) -> None:
    assert Play(world, before=lambda play: void(still(play))).play().heard == Play(world).play().heard


@given(worlds(adds=True))
def test_the_same_inputs_give_the_same_effects_and_records(world: World) -> None:
    one, other = (Play(world, traced=True).play() for _ in range(2))
    assert one.heard == other.heard
    assert one.trace == other.trace


@given(worlds(), st.integers(0, 3))
def test_an_added_rule_that_never_runs_changes_nothing(world: World, steps: int) -> None:
    """The rule is added to a live engine. One more rule changes all utilities (L9), so the test restores them."""
    plain = Play(world)
    changed = Play(world)
    for _ in range(steps):
        if not (plain.step() and changed.step()):
            break
    policy = changed.engine.policy
    assert changed.names is not None
    deaf = rule_of(changed.names, RuleOf(((Want("never"),),)), "deaf")
    more = policy.with_rule(deaf)
    for index, clause in policy.clause_plans.items():
        same = more.clause_plans[index]
        same.base, same.utility, same.unrivalled = clause.base, clause.utility, clause.unrivalled
    for old, new in zip(policy.signal_plans, more.signal_plans, strict=True):
        new.conflict_sets = tuple(
            tuple(more.clause_plans[clause.index] for clause in clauses) for clauses in old.conflict_sets
        )
    changed.engine.receive(AddRule(more), changed.now)
    changed.pump()
    assert changed.play().heard == plain.play().heard


def test_the_hash_seed_does_not_affect_the_effects() -> None:
    batch: list[World] = []

    @settings(max_examples=60, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
    @given(worlds())
    def collect(world: World) -> None:
        batch.append(world)

    collect()
    told = pickle.dumps(batch)
    code = (
        "import pickle, sys\n"
        "from properties.worlds import Play\n"
        "for number, world in enumerate(pickle.load(sys.stdin.buffer)):\n"
        "    play = Play(world, traced=True).play()\n"
        "    for line in play.heard + play.trace: print(number, line)\n"
    )
    answers: list[list[str]] = []
    for seed in ("0", "1", "2", "42"):
        path = os.pathsep.join([str(SOURCES), str(TESTS)])
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path}
        done = subprocess.run(
            [sys.executable, "-c", code], input=told, env=environment, capture_output=True, check=False
        )
        assert done.returncode == 0, done.stderr.decode()
        answers.append(done.stdout.decode().splitlines())
    first = answers[0]
    assert first
    for other in answers[1:]:
        for mine, theirs in zip(first, other, strict=True):
            assert mine == theirs, batch[int(mine.split()[0])]


def void(_: object) -> None:
    """Ignore a value."""
