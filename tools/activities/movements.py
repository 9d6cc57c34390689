"""Movements of the parametric body: each function turns a phase into paths of hands, feet and torso.

Each performance has a style of its own: amplitudes, places and coordination are drawn at random. All movements are written
for a right-handed performer; `camera.py` mirrors half of the performances.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from body import Array, Motion

Movement = Callable[[Array, np.random.Generator], Motion]


def _about(rng: np.random.Generator, *centre: float, spread: float = 0.06) -> Array:
    """Return a point near `centre`."""
    return np.array(centre) + rng.normal(0, spread, len(centre))


def _much(rng: np.random.Generator, size: float, spread: float = 0.2) -> float:
    return size * float(np.exp(rng.normal(0, spread)))


def _path(centre: Array, *moves: tuple[Array, tuple[float, float, float]]) -> Array:
    """Return a path: a centre, plus waves (one number for each frame) along directions."""
    return centre + sum(wave[:, None] * np.array(way) for wave, way in moves)


def _sharp(wave: Array, power: float = 0.6) -> Array:
    return np.sign(wave) * np.abs(wave) ** power


def _idle(p: Array, rng: np.random.Generator) -> Motion:
    m = Motion.rest(len(p))
    slow = np.sin(p * 0.23 + rng.uniform(0, 6))
    m.sway += 0.03 * slow
    m.left = m.left + rng.normal(0, 0.04, 3)
    m.right = m.right + rng.normal(0, 0.04, 3)
    return m


def waving(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.24)
    m.right = _path(
        _about(rng, -0.55, 0.5, 0.25, spread=0.1), (np.sin(p), (size, 0, 0)), (np.cos(2 * p), (0, -0.15 * size, 0))
    )
    return m


def clapping(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    apart = 0.04 + _much(rng, 0.17) * (1 + np.cos(p)) / 2
    centre = _about(rng, 0, -0.35, 0.5, spread=0.08) * [0.3, 1, 1]
    m.left, m.right = (_path(centre, (side * apart, (1, 0, 0))) for side in (1, -1))
    m.elbows = 0.4
    return m


def jumping(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    wave = np.sin(p)
    m.leap = _much(rng, 0.35) * np.maximum(wave, 0)
    m.drop = _much(rng, 0.28) * np.maximum(-wave, 0)
    swing = _much(rng, 0.2, 0.5)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.5, -0.85, 0.15), (wave, (0.3 * side * swing, swing, 0.3 * swing))))
    return m


def squatting(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    down = (1 - np.cos(p)) / 2
    m.drop = _much(rng, 0.75, 0.15) * down
    m.lean = _much(rng, 0.45) * down
    out = rng.uniform(0, 1)
    for side, name in ((1, "left"), (-1, "right")):
        ahead = (
            _about(rng, side * 0.25, -0.25, 0.85) * down[:, None]
            + _about(rng, side * 0.35, -0.9, 0.2) * (1 - down)[:, None]
        )
        still = _about(rng, side * 0.25, -0.2, 0.85)
        setattr(m, name, ahead if out < 0.6 else np.tile(still, (len(p), 1)))
    return m


def boxing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.5, 0.15)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        punch = np.maximum(np.sin(p + at), 0) ** 1.5
        setattr(m, name, _path(_about(rng, side * 0.2, -0.12, 0.36), (punch, (-0.1 * side, 0.08, size))))
    m.twist = _much(rng, 0.25) * np.sin(p + np.pi)
    m.drop += 0.08
    return m


def swimming(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.7, 0.12)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        q = p + at
        setattr(
            m,
            name,
            _path(_about(rng, side * 0.45, 0.0, 0.1), (np.cos(q), (0, size, 0)), (np.sin(q), (0.1 * side, 0, size))),
        )
    m.lean = np.full(len(p), rng.uniform(0.1, 0.7))
    m.twist = _much(rng, 0.3) * np.sin(p)
    m.elbows = 0.5
    return m


def playing_the_guitar(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.left = _path(_about(rng, 0.75, -0.35, 0.35), (np.sin(p * 0.3), _tuple(rng, 0.06)))
    m.right = _path(_about(rng, -0.1, -0.72, 0.32), (np.sin(p), (0.06, _much(rng, 0.15), 0)))
    m.nod = 0.15 + 0.08 * np.sin(p * 0.5)
    return m


def drinking(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    up = np.clip((1 - np.cos(p)) * 0.75, 0, 1)
    low = _about(rng, -0.25, -0.55, 0.42, spread=0.08)
    m.right = low + up[:, None] * (_about(rng, -0.08, 0.3, 0.34, spread=0.04) - low)
    m.nod = -_much(rng, 0.35) * up
    return m


def phoning(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.24, 0.36, 0.12, spread=0.04), (np.sin(p * 0.4), _tuple(rng, 0.03)))
    m.nod = 0.06 * np.sin(p * 0.3)
    m.sway = 0.05 * np.sin(p * 0.2) - 0.05
    return m


def brushing_teeth(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.18, 0.27, 0.4, spread=0.04), (np.sin(p), (_much(rng, 0.1), 0.02, 0.03)))
    m.elbows = rng.uniform(0.1, 0.6)
    return m


def driving(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    centre = _about(rng, 0, -0.35, 0.62) * [0.2, 1, 1]
    radius, turn = _much(rng, 0.3, 0.1), _much(rng, 0.55) * np.sin(p)
    m.left = _path(centre, (np.cos(turn), (radius, 0, 0)), (np.sin(turn), (0, radius, 0)))
    m.right = _path(centre, (np.cos(turn), (-radius, 0, 0)), (np.sin(turn), (0, -radius, 0)))
    return m


def rowing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    pull = np.sin(p)
    size = _much(rng, 0.33, 0.12)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(
            m,
            name,
            _path(
                _about(rng, side * 0.22, -0.45, 0.55, spread=0.05),
                (pull, (0.05 * side, 0.04, size)),
                (np.cos(p), (0, 0.08, 0)),
            ),
        )
    m.lean = 0.1 + _much(rng, 0.3) * pull
    m.drop += rng.choice([0.0, 0.5, 0.7])
    return m


def running(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.25)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        setattr(m, name, _path(_about(rng, side * 0.36, -0.5, 0.3), (np.sin(p + at), (0, 0.6 * size, size))))
    lift = _much(rng, 0.4)
    for index, at in ((0, np.pi), (1, 0.0)):
        up = np.maximum(np.sin(p + at), 0)
        m.steps[:, index] = up[:, None] * np.array([0, lift, rng.uniform(-0.3, 0.25)])
    m.leap = 0.06 * np.abs(np.cos(p))
    m.lean += 0.1
    return m


def conducting(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.22)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(
            m,
            name,
            _path(_about(rng, side * 0.42, 0.1, 0.5), (np.cos(2 * p), (0, size, 0)), (np.sin(p), (side * size, 0, 0))),
        )
    return m


def hammering(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.left = np.tile(_about(rng, 0.08, -0.35, 0.55), (len(p), 1))
    size = _much(rng, 0.32, 0.15)
    m.right = _path(_about(rng, -0.15, -0.02, 0.5), (_sharp(np.sin(p)), (-0.05, size, -0.35 * size)))
    return m


def flying(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.4)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(
            m,
            name,
            _path(
                _about(rng, side * 1.25, -0.05, 0.05), (np.sin(p), (0, size, 0)), (np.cos(2 * p), (0.1 * side, 0, 0))
            ),
        )
    m.elbows = 0.3
    return m


# -------------------------------------------------------- movements that the recogniser is not taught


def juggling(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.16)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        q = p + at
        setattr(
            m,
            name,
            _path(
                _about(rng, side * 0.3, -0.5, 0.45), (np.cos(q), (side * 0.6 * size, 0, 0)), (np.sin(q), (0, size, 0))
            ),
        )
    return m


def jumping_jacks(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    open_ = (1 - np.cos(p)) / 2
    for side, name in ((1, "left"), (-1, "right")):
        angle = -1.4 + 2.7 * open_
        setattr(m, name, np.stack([side * (0.36 + np.cos(angle)), np.sin(angle), 0 * p + 0.05], axis=1))
    m.leap = 0.15 * np.sin(p) ** 2
    m.steps[:, 0, 0], m.steps[:, 1, 0] = 0.35 * open_, -0.35 * open_
    return m


def bowing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.lean = _much(rng, 1.0, 0.15) * (1 - np.cos(p)) / 2
    return m


def playing_the_violin(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.left = np.tile(_about(rng, 0.6, 0.12, 0.5), (len(p), 1))
    m.right = _path(_about(rng, -0.1, 0.0, 0.5), (np.sin(p), (_much(rng, 0.25), 0.15, -0.1)))
    m.nod, m.sway = m.nod + 0.2, m.sway + 0.1
    return m


def stirring(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.16)
    m.right = _path(_about(rng, -0.1, -0.5, 0.55), (np.cos(p), (size, 0, 0)), (np.sin(p), (0, 0, size)))
    m.left = np.tile(_about(rng, 0.3, -0.6, 0.4), (len(p), 1)) if rng.random() < 0.6 else m.left
    return m


def typing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        setattr(
            m,
            name,
            _path(
                _about(rng, side * 0.16, -0.6, 0.5),
                (np.sin(p + at), (0, 0.04, 0)),
                (np.sin(p * 0.3 + at), (0.06, 0, 0)),
            ),
        )
    m.nod = m.nod + 0.2
    return m


def twisting(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.twist, m.sway = _much(rng, 0.6) * np.sin(p), 0.2 * np.cos(p)
    m.drop += 0.1
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, np.tile(_about(rng, side * 0.5, -0.45, 0.4), (len(p), 1)))
    return m


def kicking(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    up = np.maximum(np.sin(p), 0)
    m.steps[:, 1] = up[:, None] * [0, _much(rng, 0.5), _much(rng, 0.8)] - np.maximum(-np.sin(p), 0)[:, None] * [
        0,
        -0.2,
        0.4,
    ]
    m.lean = -0.15 * up
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.55, -0.8, 0.1), (np.sin(p), (0, 0.1, side * 0.2))))
    return m


def walking(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    swing, stride = _much(rng, 0.25), _much(rng, 0.35)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        setattr(m, name, _path(_about(rng, side * 0.42, -1.0, 0.08), (np.sin(p + at), (0, 0.1 * swing, swing))))
    for index, at in ((0, np.pi), (1, 0.0)):
        m.steps[:, index, 2] = stride * np.sin(p + at)
        m.steps[:, index, 1] = 0.15 * np.maximum(np.cos(p + at), 0)
    return m


def standing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    kind = rng.integers(4)
    places = {1: (0.25, -0.75, 0.0), 2: (0.05, -0.35, 0.28), 3: (0.08, -0.8, 0.25)}
    if kind:
        x, y, z = places[int(kind)]
        for side, name in ((1, "left"), (-1, "right")):
            setattr(m, name, np.tile(_about(rng, side * x, y, z, spread=0.04), (len(p), 1)))
        m.elbows = 0.6 if kind == 1 else 0.2
    return m


def scratching(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.12, 0.62, 0.05), (np.sin(p), (0.05, 0.04, 0.06)))
    m.elbows = 0.8
    return m


def tennis(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.6)
    m.right = _path(_about(rng, -0.35, -0.2, 0.35), (np.sin(p), (size, 0.2, 0)), (np.cos(p), (0, 0.1, 0.3)))
    m.twist = 0.6 * np.sin(p)
    return m


def archery(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.left = np.tile(_about(rng, 1.1, 0.05, 0.3), (len(p), 1))
    m.right = _path(_about(rng, 0.2, 0.08, 0.3), (_sharp(np.sin(p)), (-0.35, 0, -0.05)))
    m.elbows = 0.9
    return m


def fidgeting(p: Array, rng: np.random.Generator) -> Motion:
    """Both hands wander about without a plan; sometimes the body does too."""
    m = _idle(p, rng)
    for side, name in ((1, "left"), (-1, "right")):
        if rng.random() < 0.8:
            centre = np.array([side * rng.uniform(0, 0.8), rng.uniform(-0.9, 0.6), rng.uniform(0.1, 0.7)])
            size = _much(rng, 0.18, 0.6)
            waves = [(np.sin(p * rng.uniform(0.2, 1.6) + rng.uniform(0, 6)), _tuple(rng, size)) for _ in range(3)]
            setattr(m, name, _path(centre, *waves))
    m.lean = rng.normal(0, 0.15) + _much(rng, 0.1, 0.6) * np.sin(p * rng.uniform(0.2, 1) + rng.uniform(0, 6))
    m.twist = _much(rng, 0.15, 0.6) * np.sin(p * rng.uniform(0.2, 1) + rng.uniform(0, 6))
    if rng.random() < 0.3:
        m.drop = 0.2 * (1 + np.sin(p * rng.uniform(0.3, 1)))
    m.elbows = rng.uniform(0, 0.6)
    return m


def playing_the_piano(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name, at in ((1, "left", rng.uniform(0, 6)), (-1, "right", 0.0)):
        setattr(
            m,
            name,
            _path(
                _about(rng, side * 0.3, -0.5, 0.6),
                (np.sin(p + at), (0, 0.06, 0)),
                (np.sin(p * 0.35 + at), (0.25, 0, 0)),
            ),
        )
    return m


def golf(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    angle = _much(rng, 1.6, 0.1) * np.sin(p)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(
            m, name, np.stack([0.85 * np.sin(angle), -0.85 * np.cos(angle) + 0.1, 0 * p + 0.35 + side * 0.03], axis=1)
        )
    m.lean, m.twist = m.lean + 0.4, 0.5 * np.sin(p)
    return m


def throwing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    size = _much(rng, 0.5)
    m.right = _path(_about(rng, -0.4, 0.3, 0.15), (np.sin(p), (0.15, -0.2, size)), (np.cos(p), (0, 0.25, 0)))
    m.twist = 0.4 * np.sin(p)
    m.lean = 0.1 + 0.15 * np.sin(p)
    return m


def climbing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        setattr(m, name, _path(_about(rng, side * 0.3, 0.3, 0.5), (np.sin(p + at), (0, _much(rng, 0.35, 0.1), 0))))
    for index, at in ((0, np.pi), (1, 0.0)):
        m.steps[:, index] = np.maximum(np.sin(p + at), 0)[:, None] * [0, _much(rng, 0.5), 0.3]
    return m


def saluting(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    up = np.clip((1 - np.cos(p)) * 0.8, 0, 1)[:, None]
    m.right = m.right * (1 - up) + up * _about(rng, -0.2, 0.5, 0.22, spread=0.04)
    m.elbows = 0.9
    return m


def stretching(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.sway = _much(rng, 0.4) * np.sin(p)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, np.tile(_about(rng, side * 0.15, 1.0, 0.05), (len(p), 1)))
    return m


def lifting(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.5, 0.5, 0.15), (np.sin(p), (0, _much(rng, 0.42, 0.1), 0))))
    return m


def skiing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.42, -0.45, 0.2), (np.sin(p), (0, 0.4, 0.55))))
    m.lean = 0.5 - 0.35 * np.sin(p)
    m.drop = 0.15 - 0.12 * np.sin(p)
    return m


def vacuuming(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.2, -0.75, 0.5), (np.sin(p), (0, -0.1, _much(rng, 0.35))))
    m.lean = 0.3 + 0.1 * np.sin(p)
    m.twist = 0.2 * np.sin(p)
    return m


def shrugging(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    up = (1 - np.cos(p)) / 2
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.5, -0.75, 0.3), (up, (side * 0.2, 0.25, 0.1))))
    return m


def ironing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.05, -0.7, 0.5), (np.sin(p), (_much(rng, 0.35), 0, 0)))
    m.left = np.tile(_about(rng, 0.45, -0.7, 0.45), (len(p), 1))
    m.lean += 0.2
    return m


def digging(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    wave = np.sin(p)
    m.left = _path(_about(rng, 0.25, -0.75, 0.6), (wave, (0.3, 0.25, 0)))
    m.right = _path(_about(rng, -0.15, -0.6, 0.3), (wave, (0.25, 0.2, 0)))
    m.lean, m.twist = 0.6 - 0.35 * wave, 0.4 * wave
    m.drop = 0.2 - 0.15 * wave
    return m


def pointing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.5, 0.0, 0.9, spread=0.15), (np.sin(p * 0.3), _tuple(rng, 0.08)))
    return m


def curling(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi * rng.integers(2))):
        angle = -0.4 + 1.2 * np.sin(p + at)
        setattr(
            m, name, np.stack([0 * p + side * 0.4, -0.56 + 0.48 * np.sin(angle), 0.1 + 0.48 * np.cos(angle)], axis=1)
        )
    return m


def sawing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.3, -0.6, 0.3), (np.sin(p), (0.05, -0.15, _much(rng, 0.3))))
    m.left = np.tile(_about(rng, 0.15, -0.75, 0.5), (len(p), 1))
    m.lean += 0.4
    return m


def tying_shoes(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.1, -0.85, 0.6), (np.sin(p), (side * 0.12, 0.05, 0))))
    m.lean = np.full(len(p), rng.uniform(0.9, 1.3))
    m.drop += rng.uniform(0.6, 1.0)
    return m


def hula_hoop(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.lean, m.sway = 0.2 * np.sin(p), 0.2 * np.cos(p)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, np.tile(_about(rng, side * 0.8, -0.1, 0.15), (len(p), 1)))
    return m


def praying(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, np.tile(_about(rng, side * 0.03, -0.15, 0.35, spread=0.03), (len(p), 1)))
    m.nod = 0.4 + 0.05 * np.sin(p * 0.3)
    return m


def pulling_a_rope(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    for side, name, at in ((1, "left", 0), (-1, "right", np.pi)):
        setattr(
            m,
            name,
            _path(_about(rng, side * 0.05, 0.1, 0.4), (np.sin(p + at), (0, 0.5, 0)), (np.cos(p + at), (0, 0, 0.1))),
        )
    return m


def skating(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.lean, m.sway = m.lean + 0.5, 0.2 * np.sin(p)
    m.drop += 0.25
    for index, side in ((0, 1), (1, -1)):
        m.steps[:, index, 0] = side * 0.5 * np.maximum(side * np.sin(p), 0)
    for side, name in ((1, "left"), (-1, "right")):
        setattr(m, name, _path(_about(rng, side * 0.4, -0.6, 0.2), (np.sin(p), (0.45, 0.1, 0.3 * side))))
    return m


def combing(p: Array, rng: np.random.Generator) -> Motion:
    m = _idle(p, rng)
    m.right = _path(_about(rng, -0.28, 0.5, 0.05), (np.sin(p), (0.05, _much(rng, 0.22), -0.1)))
    m.elbows = 0.8
    return m


def _tuple(rng: np.random.Generator, size: float) -> tuple[float, float, float]:
    x, y, z = rng.normal(0, size, 3)
    return float(x), float(y), float(z)


KNOWN: dict[str, tuple[Movement, float]] = {
    "waving": (waving, 1.6),
    "clapping": (clapping, 2.2),
    "jumping": (jumping, 1.4),
    "squatting": (squatting, 0.6),
    "boxing": (boxing, 1.5),
    "swimming": (swimming, 0.8),
    "playing the guitar": (playing_the_guitar, 1.9),
    "drinking": (drinking, 0.45),
    "phoning": (phoning, 1.0),
    "brushing teeth": (brushing_teeth, 3.0),
    "driving": (driving, 0.6),
    "rowing": (rowing, 0.7),
    "running": (running, 1.9),
    "conducting": (conducting, 0.9),
    "hammering": (hammering, 1.6),
    "flying": (flying, 1.0),
}
"""Name → movement, and its cycles per second."""

OTHERS: dict[str, tuple[Movement, float]] = {
    "bowing": (bowing, 0.5),
    "playing the violin": (playing_the_violin, 1.0),
    "stirring": (stirring, 1.0),
    "typing": (typing, 3.0),
    "twisting": (twisting, 1.2),
    "kicking": (kicking, 0.8),
    "standing": (standing, 0.5),
    "scratching": (scratching, 2.5),
    "tennis": (tennis, 0.7),
    "jumping jacks": (jumping_jacks, 1.0),
    "fidgeting": (fidgeting, 1.0),
    "pointing": (pointing, 0.6),
    "lifting": (lifting, 0.6),
}
"""Movements from which the starter set learns the answer *none of the activities*."""

STRANGE: dict[str, tuple[Movement, float]] = {
    "juggling": (juggling, 1.6),
    "walking": (walking, 0.9),
    "archery": (archery, 0.6),
    "playing the piano": (playing_the_piano, 2.0),
    "golf": (golf, 0.5),
    "throwing": (throwing, 0.8),
    "climbing": (climbing, 0.8),
    "saluting": (saluting, 0.5),
    "stretching": (stretching, 0.5),
    "skiing": (skiing, 0.8),
    "vacuuming": (vacuuming, 0.7),
    "shrugging": (shrugging, 0.6),
    "ironing": (ironing, 0.6),
    "digging": (digging, 0.5),
}
"""Movements that are not in the starter set. Only tests use them."""

UNTOUCHED: dict[str, tuple[Movement, float]] = {
    "curling": (curling, 0.7),
    "sawing": (sawing, 1.2),
    "tying shoes": (tying_shoes, 1.0),
    "hula hoop": (hula_hoop, 1.2),
    "praying": (praying, 0.7),
    "pulling a rope": (pulling_a_rope, 0.8),
    "skating": (skating, 0.5),
    "combing": (combing, 0.8),
}
"""More movements that are not in the starter set, written after the recogniser was finished. No choice in the
recogniser depends on them."""
