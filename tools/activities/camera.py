"""Performances before a camera: performers, tempo, point of view, noise and cut-off limbs, as landmarks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from body import Array, Body, pose
from movements import Movement

SWAPPED = [0, 4, 5, 6, 1, 2, 3, 8, 7, 10, 9, *(i + 1 if i % 2 else i - 1 for i in range(11, 33))]
"""The landmark of the other side, for each landmark."""


@dataclass(frozen=True)
class Conditions:
    """How much performances differ. `HELD_OUT` (for the score) goes beyond `TAUGHT` (for learning) in each respect."""

    bodies: float
    """The spread of the proportions of bodies, as a share."""
    tempo: float
    """The greatest factor by which the tempo is faster or slower than usual."""
    yaw: float
    """The greatest angle between the performer's front and the camera, in degrees."""
    near: float
    """The least distance of the camera, in torso lengths."""
    far: float
    """The greatest distance of the camera, in torso lengths."""
    noise: float
    """The greatest standard deviation of a landmark, in torso lengths; for the depth, three times as much."""
    cut: float
    """The share of performances with the legs outside the picture."""
    lost: float
    """The share of performances in which a hand or an elbow is lost for a part of the time."""


TAUGHT = Conditions(bodies=0.07, tempo=1.6, yaw=50, near=3.5, far=9, noise=0.025, cut=0.3, lost=0.2)
HELD_OUT = Conditions(bodies=0.11, tempo=1.9, yaw=60, near=3.0, far=12, noise=0.03, cut=0.4, lost=0.3)


def perform(
    movement: Movement,
    rate: float,
    conditions: Conditions,
    rng: np.random.Generator,
    seconds: float = 3.0,
    *,
    left: float = 0.5,
) -> tuple[Array, Array]:
    """Return the times (T,) and the landmarks (T, 33, 4) of one performance, as MediaPipe would give them.

    Args:
        movement: The movement.
        rate: Its usual cycles per second.
        conditions: How much performers, cameras and noise differ.
        rng: The source of random numbers.
        seconds: The length of the performance.
        left: The share of left-handed performers.
    """
    fps = rng.uniform(10, 30)
    times = np.arange(0, seconds, 1 / fps)
    tempo = rate * np.exp(rng.uniform(-1, 1) * np.log(conditions.tempo))
    drift = 1 + 0.15 * np.sin(times * rng.uniform(0.5, 2) + rng.uniform(0, 6))
    phase = rng.uniform(0, 2 * np.pi) + 2 * np.pi * np.cumsum(tempo * drift) / fps
    marks = pose(Body.random(rng, conditions.bodies), movement(phase, rng))
    if rng.random() < left:
        marks = marks[:, SWAPPED] * [-1, 1, 1]
    return times, seen(marks, conditions, rng)


def seen(marks: Array, conditions: Conditions, rng: np.random.Generator) -> Array:
    """Return the landmarks (T, 33, 4) of a body (T, 33, 3) before a camera."""
    frames = len(marks)
    yaw = np.radians(rng.uniform(-1, 1) * conditions.yaw)
    turned = marks @ np.array([[np.cos(yaw), 0, -np.sin(yaw)], [0, 1, 0], [np.sin(yaw), 0, np.cos(yaw)]])
    distance = rng.uniform(conditions.near, conditions.far)
    eye = np.array([rng.normal(0, 0.3), rng.uniform(1.2, 3.6), distance])
    aim = np.array([eye[0] * 0.7, rng.uniform(1.8, 2.6), 0.0])
    forward = (aim - eye) / np.linalg.norm(aim - eye)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    beside = turned - eye
    depth = np.maximum(beside @ forward, 0.5)
    zoom = distance / rng.uniform(3.5, 6.0)
    x, y = beside @ right / depth * zoom, -(beside @ up) / depth * zoom
    middle = depth[:, 23:25].mean(axis=1, keepdims=True)
    z = (depth - middle) / middle * zoom * rng.uniform(0.7, 1.2)
    scale = np.median(np.hypot(x[:, 11] - x[:, 23], y[:, 11] - y[:, 23]))
    sigma = scale * rng.uniform(0.3, 1) * conditions.noise
    points = np.stack([x, y, z], axis=-1)
    points += rng.normal(0, 1, points.shape) * [sigma, sigma, 3 * sigma]
    points[..., 2] += rng.normal(0, 2 * sigma, (1, 33))
    visible = np.clip(rng.normal(0.97, 0.02, (frames, 33)), 0, 1)
    lost = np.zeros((frames, 33), dtype=bool)
    if rng.random() < conditions.cut:
        hip, foot = points[:, 23:25, 1].mean(), points[:, 27:29, 1].mean()
        lost |= points[..., 1] > hip + (foot - hip) * rng.uniform(0.05, 0.9)
        lost[:, :23] = False
    if rng.random() < conditions.lost:
        side = int(rng.integers(2))
        gone = [15, 17, 19, 21] if rng.random() < 0.6 else [13]
        begin = int(rng.integers(frames))
        lost[begin : begin + int(frames * rng.uniform(0.1, 0.5)), [one + side for one in gone]] = True
    visible[lost] = rng.uniform(0.0, 0.4, int(lost.sum()))
    points[lost] += rng.normal(0, 0.25 * scale, (int(lost.sum()), 3))
    return np.concatenate([points, visible[..., None]], axis=-1)
