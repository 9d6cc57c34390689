"""A parametric body: a skeleton whose hands and feet follow given paths.

The unit of length is the torso (hips to shoulders). Axes: x to the performer's left, y up, z to the front; the origin is
on the ground between the feet.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """The proportions of a performer, in torso lengths."""

    shoulders: float = 0.36
    """Half the distance between the shoulders."""
    hips: float = 0.2
    """Half the distance between the hips."""
    upper_arm: float = 0.58
    forearm: float = 0.5
    thigh: float = 0.82
    shank: float = 0.82
    neck: float = 0.42
    """From the shoulders to the middle of the head."""
    head: float = 0.22
    """Half the head's height."""

    @classmethod
    def random(cls, rng: np.random.Generator, spread: float) -> Body:
        """Return proportions that differ from the average by about `spread`, as a share."""
        average = cls()
        return cls(**{name: value * float(rng.normal(1, spread)) for name, value in vars(average).items()})


@dataclass
class Motion:
    """The paths of a performer over T frames, for an average body. Hands are relative to the middle of the shoulders,
    in the frame of the torso."""

    left: Array
    """(T, 3) the left wrist."""
    right: Array
    """(T, 3) the right wrist."""
    drop: Array
    """(T,) how far the hips sink, with bent knees."""
    leap: Array
    """(T,) how far the whole body leaves the ground."""
    lean: Array
    """(T,) the torso's pitch to the front, in radians."""
    twist: Array
    """(T,) the torso's turn to the left, in radians."""
    sway: Array
    """(T,) the torso's roll to the left, in radians."""
    nod: Array
    """(T,) the head's pitch to the front, in radians."""
    steps: Array
    """(T, 2, 3) the offsets of the left and of the right foot."""
    elbows: float = 0.0
    """How far the elbows point outwards instead of down, 0 to 1."""

    @classmethod
    def rest(cls, frames: int) -> Motion:
        """Return a body that stands still, with hanging arms."""
        still = np.zeros(frames)
        hanging = np.tile([0.42, -1.02, 0.08], (frames, 1))
        parts = [still.copy() for _ in range(6)]
        return cls(hanging, hanging * [-1, 1, 1], *parts, np.zeros((frames, 2, 3)))


def pose(body: Body, motion: Motion) -> Array:
    """Return the landmarks, (T, 33, 3), in MediaPipe's order."""
    frames = len(motion.drop)
    legs = body.thigh + body.shank
    ground = np.stack(
        [np.stack([np.full(frames, side * body.hips), np.zeros(frames), np.zeros(frames)], axis=1) for side in (1, -1)],
        axis=1,
    )
    ankles = ground + motion.steps + motion.leap[:, None, None] * [0, 1, 0]
    height = legs * 0.985 - motion.drop * (legs / 1.64) + motion.leap
    hip = np.stack([np.zeros(frames), height, -0.35 * motion.drop], axis=1)
    turn = _rotation(motion.lean, motion.twist, motion.sway)
    hips = [hip + np.array([side * body.hips, 0, 0]) for side in (1, -1)]
    neck = hip + _turned(turn, np.tile([0.0, 1.0, 0.0], (frames, 1)))
    shoulders = [neck + _turned(turn, np.tile([side * body.shoulders, 0.0, 0.0], (frames, 1))) for side in (1, -1)]
    reach = (body.upper_arm + body.forearm) / 1.08
    wrists, elbows = [], []
    for side, path, shoulder in zip((1, -1), (motion.left, motion.right), shoulders, strict=True):
        # Paths are for an average body: they keep their place relative to the shoulder, and scale with the arm's
        # length.
        own = (path - [side * 0.36, 0, 0]) * reach + [side * body.shoulders, 0, 0]
        bend = np.array([side * (0.25 + motion.elbows), -1.0 + 0.6 * motion.elbows, -0.35])
        wrist, elbow = _joint(
            shoulder, neck + _turned(turn, own), body.upper_arm, body.forearm, _turned(turn, np.tile(bend, (frames, 1)))
        )
        wrists.append(wrist)
        elbows.append(elbow)
    knees = []
    for index, joint in enumerate(hips):
        ankles[:, index], knee = _joint(
            joint, ankles[:, index], body.thigh, body.shank, np.tile([0.15 * (1 - 2 * index), 0.0, 1.0], (frames, 1))
        )
        knees.append(knee)
    tilt = _rotation(motion.lean * 0.5 + motion.nod, motion.twist, motion.sway)

    def on_head(x: float, y: float, z: float) -> Array:
        return (
            neck
            + _turned(turn, np.tile([0, body.neck * 0.5, 0], (frames, 1)))
            + _turned(tilt, np.tile([x, y + body.neck * 0.5, z], (frames, 1)))
        )

    size = body.head / 0.22
    marks = np.zeros((frames, 33, 3))
    marks[:, 0] = on_head(0, 0, 0.2 * size)
    for index, x in zip((1, 2, 3, 4, 5, 6), (0.03, 0.06, 0.09, -0.03, -0.06, -0.09), strict=True):
        marks[:, index] = on_head(x * size, 0.07 * size, 0.16 * size)
    for index, side in ((7, 1), (8, -1)):
        marks[:, index] = on_head(side * 0.14 * size, 0.03 * size, 0.02)
    for index, side in ((9, 1), (10, -1)):
        marks[:, index] = on_head(side * 0.05 * size, -0.08 * size, 0.16 * size)
    for side in (0, 1):
        marks[:, 11 + side], marks[:, 13 + side], marks[:, 15 + side] = shoulders[side], elbows[side], wrists[side]
        along = wrists[side] - elbows[side]
        along = along / np.linalg.norm(along, axis=1, keepdims=True)
        for index, length in ((17, 0.17), (19, 0.19), (21, 0.1)):
            marks[:, index + side] = wrists[side] + along * length
        marks[:, 23 + side], marks[:, 25 + side], marks[:, 27 + side] = hips[side], knees[side], ankles[:, side]
        marks[:, 29 + side] = ankles[:, side] + [0, -0.1, -0.1]
        marks[:, 31 + side] = ankles[:, side] + [0, -0.1, 0.3]
    return marks


def _rotation(lean: Array, twist: Array, sway: Array) -> Array:
    """Return rotation matrices, (T, 3, 3)."""
    zero, one = np.zeros_like(lean), np.ones_like(lean)
    pitch = np.stack([one, zero, zero, zero, np.cos(lean), -np.sin(lean), zero, np.sin(lean), np.cos(lean)], -1)
    yaw = np.stack([np.cos(twist), zero, np.sin(twist), zero, one, zero, -np.sin(twist), zero, np.cos(twist)], -1)
    roll = np.stack([np.cos(sway), np.sin(sway), zero, -np.sin(sway), np.cos(sway), zero, zero, zero, one], -1)
    shape = (-1, 3, 3)
    return yaw.reshape(shape) @ pitch.reshape(shape) @ roll.reshape(shape)


def _turned(rotation: Array, points: Array) -> Array:
    return np.einsum("tij,tj->ti", rotation, points)


def _joint(root: Array, end: Array, first: float, second: float, bend: Array) -> tuple[Array, Array]:
    """Return the reachable end of a limb of two bones, and the joint between them, which points towards `bend`."""
    way = end - root
    distance = np.linalg.norm(way, axis=1, keepdims=True)
    along = way / np.maximum(distance, 1e-6)
    distance = np.clip(distance, abs(first - second) + 0.02, (first + second) * 0.995)
    share = (first**2 - second**2 + distance**2) / (2 * distance)
    aside = np.sqrt(np.maximum(first**2 - share**2, 0))
    across = bend - (bend * along).sum(axis=1, keepdims=True) * along
    across = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-6)
    return root + along * distance, root + along * share + across * aside
