"""Write the starter set of activities, `starter.npz`, from performances of the parametric body.

    PYTHONPATH=src .venv/bin/python tools/activities/starter.py            # write the file
    PYTHONPATH=src .venv/bin/python tools/activities/starter.py --score    # print the confusion matrix of held-out performers

No person was recorded for this set: `movements.py` describes each activity as paths of hands, feet and torso, `body.py` moves
a skeleton along them, and `camera.py` turns the result into landmarks.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
from camera import HELD_OUT, TAUGHT, Conditions, perform
from movements import KNOWN, OTHERS, STRANGE, UNTOUCHED, Movement

from ravestate.modules.modality.activity.features import features_of
from ravestate.modules.modality.activity.pose import Pose
from ravestate.modules.modality.activity.recogniser import Recogniser, Starter
from ravestate.modules.modality.activity.skeleton import skeleton_of

FILE = Path(__file__).parents[2] / "src/ravestate/modules/modality/activity/starter.npz"
EXAMPLES = 200
"""The number of performances of each movement from which the set is learnt."""
TRIALS = 60
"""The number of further performances of each movement, for fitting the limit (the greatest distance to a known
activity) and the confidence."""
KEPT = 98.5
"""The percentage of the further performances that must be within the limit."""

Table = dict[str, tuple[Movement, float]]


def poses_of(
    movement: Movement, rate: float, conditions: Conditions, rng: np.random.Generator, *, left: float = 0.5
) -> list[Pose]:
    """Return the poses of one performance."""
    times, points = perform(movement, rate, conditions, rng, left=left)
    return [Pose(float(at), mark.astype(np.float32)) for at, mark in zip(times, points, strict=True)]


def performances(table: Table, count: int, conditions: Conditions, seed: int, *, left: float = 0.5) -> dict[str, Any]:
    """Return name → one pair for each performance: its features, and those of its mirror image."""
    found: dict[str, Any] = {}
    for index, (name, (movement, rate)) in enumerate(table.items()):
        rng = np.random.default_rng([seed, index])
        skeletons = [skeleton_of(poses_of(movement, rate, conditions, rng, left=left)) for _ in range(count)]
        found[name] = [(features_of(one), features_of(one.mirrored())) for one in skeletons if one is not None]
    return found


def make() -> Starter:
    """Return the starter set."""
    known = performances(KNOWN, EXAMPLES, TAUGHT, 1, left=0.0)
    others = performances(OTHERS, EXAMPLES, TAUGHT, 2, left=0.0)
    starter = Starter.learn(
        {name: [one for one, _ in pairs] for name, pairs in known.items()},
        [[one for one, _ in pairs] for pairs in others.values()],
    )
    recogniser = Recogniser(starter)
    trials = performances(KNOWN, TRIALS, TAUGHT, 3)
    found = [(name, recogniser.recognise_features(pair)) for name, pairs in trials.items() for pair in pairs]
    own = [one.distance for name, one in found if one.nearest == name]
    starter = dataclasses.replace(starter, limit=float(np.percentile(own, KEPT)))
    return dataclasses.replace(starter, heat=_heat(starter, trials))


def _heat(starter: Starter, trials: dict[str, Any]) -> float:
    """Return the heat (`Starter.heat`) at which the confidence best matches the share of right answers."""
    best, least = 1.0, np.inf
    for heat in (4.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0):
        recogniser = Recogniser(dataclasses.replace(starter, heat=heat, limit=np.inf))
        results = [(name, recogniser.recognise_features(pair)) for name, pairs in trials.items() for pair in pairs]
        loss = -np.mean(
            [np.log(max(one.confidence if one.name == name else 1 - one.confidence, 1e-3)) for name, one in results]
        )
        if loss < least:
            best, least = heat, loss
    return best


def write(starter: Starter, file: Path = FILE) -> None:
    """Write a starter set."""
    data = {field.name: getattr(starter, field.name) for field in dataclasses.fields(starter)}
    arrays = {
        key: value.astype(np.float16) if isinstance(value, np.ndarray) else np.array(value)
        for key, value in data.items()
    }
    for key in ("centre", "size"):
        arrays[key] = data[key].astype(np.float32)
    np.savez_compressed(file, **arrays)


@dataclasses.dataclass(frozen=True)
class Score:
    """The result on held-out performers, which the starter set does not contain."""

    right: float
    """The share of performances of known activities that are recognised."""
    wrong: float
    """The share of these performances that the recogniser takes for another known activity. It rejects the rest."""
    rejected: float
    """The share of performances of unknown movements that are rejected."""
    untouched: float
    """The share of rejected performances among movements that were written after the recogniser was finished."""
    table: dict[str, dict[str, int]]
    """Performed → recognised (empty: nothing) → number."""


def score(count: int = 40, *, seed: int = 100, recogniser: Recogniser | None = None) -> Score:
    """Recognise performances of held-out performers."""
    recogniser = recogniser or Recogniser()
    table: dict[str, dict[str, int]] = {}
    totals = np.zeros(4)
    for number, movements in enumerate((KNOWN, STRANGE, UNTOUCHED)):
        for name, pairs in performances(movements, count, HELD_OUT, seed + number).items():
            row = table.setdefault(name, {})
            for pair in pairs:
                got = recogniser.recognise_features(pair).name
                row[got] = row.get(got, 0) + 1
                totals += (
                    name == got,
                    bool(got) and name in KNOWN and name != got,
                    not got and name in STRANGE,
                    not got and name in UNTOUCHED,
                )
    known, strange, fresh = (sum(sum(table[name].values()) for name in group) for group in (KNOWN, STRANGE, UNTOUCHED))
    return Score(*(totals / (known, known, strange, fresh)).tolist(), table)


def show(result: Score) -> str:
    """Return a score as text: the confusion matrix, with a line for each movement."""
    columns = [*KNOWN, ""]
    short = [name[:4] or "none" for name in columns]
    lines = [" " * 22 + " ".join(f"{one:>4}" for one in short)]
    for name, row in result.table.items():
        lines.append(f"{name:22}" + " ".join(f"{row.get(one, 0) or '·':>4}" for one in columns))
    lines.append(
        f"right {result.right:.1%}, taken for another {result.wrong:.1%}, "
        f"unknown rejected {result.rejected:.1%}, of movements written later {result.untouched:.1%}"
    )
    return "\n".join(lines)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--score", action="store_true", help="print the confusion matrix of held-out performers")
    if parser.parse_args().score:
        print(show(score()))
    else:
        write(make())
        print(f"wrote {FILE} ({FILE.stat().st_size / 1000:.0f} kB)")
