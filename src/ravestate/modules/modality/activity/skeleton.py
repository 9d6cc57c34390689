"""Normalise a movement that any camera has seen: make a skeleton of unit size that faces the viewer.

The skeleton has a fixed frame rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .pose import LANDMARKS, Pose

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

RATE = 20.0
"""The number of frames per second of a normalised movement."""
VISIBLE = 0.5
"""A landmark with a lower visibility than this counts as invisible."""
PRESENT = 0.5
"""A joint is used only if it is visible in at least this share of the frames."""
FEWEST = 8
"""The minimum number of poses in a movement."""
SHORTEST = 1.0
"""The minimum length of a movement, in seconds."""

NOSE, SHOULDERS, HIPS = 0, (11, 12), (23, 24)
USED = (0, 11, 12, 13, 14, 15, 16, 23, 24, 25, 26, 27, 28)
"""The landmarks that are used; the others are ignored."""
JOINTS = (0, 13, 14, 15, 16, 25, 26, 27, 28)
"""The landmarks of the joints that move: head, elbows, wrists, knees, ankles; the left joint of a pair first."""
ARMS = 5
"""The number of joints of the head and the arms, which come first in `JOINTS`. Their places are relative to the
shoulders. The places of the legs are relative to the hips."""
WIDTH = 0.72
"""The usual distance between the shoulders, in torso lengths. If no hips are visible, the length of the torso is
computed from the shoulders with this ratio."""


@dataclass(frozen=True, slots=True, eq=False)
class Skeleton:
    """A normalised movement of T frames. The torso has length 1; x points to the performer's left, y up, z forward."""

    joints: NDArray[np.float64]
    """(T, 9, 3): the places of `JOINTS`. Legs are relative to the middle of the hips, other joints to the middle of the
    shoulders."""
    present: NDArray[np.bool_]
    """(9,): whether a joint is visible for long enough; for a joint of the legs, the hips must be visible, too."""
    torso: NDArray[np.float64]
    """(T, 3): the vector from the middle of the hips to the middle of the shoulders."""
    rise: NDArray[np.float64]
    """(T,): the height of the middle of the shoulders in the picture, relative to the mean height."""
    has_hips: bool
    """Whether the hips are visible. If they are not, `torso` is meaningless."""

    def mirrored(self) -> Skeleton:
        """Return the mirror image of the movement: left becomes right."""
        swapped = [0, *(i + 1 if i % 2 else i - 1 for i in range(1, len(JOINTS)))]
        flip = [-1.0, 1.0, 1.0]
        return Skeleton(
            self.joints[:, swapped] * flip, self.present[swapped], self.torso * flip, self.rise, self.has_hips
        )


def skeleton_of(poses: Sequence[Pose]) -> Skeleton | None:
    """Return the normalised movement of some poses.

    Return None if there are too few poses, if they span too little time, or if the shoulders are not visible.

    The result does not depend on how far away the camera is, or on the side from which it looks. The camera must be
    upright and level. The origin moves with the body, and the unit is the length of the torso. The function turns the
    body about the vertical axis. After that, its shoulders (and its hips, if visible) are, on average, parallel to the
    picture.

    Args:
        poses: The poses of one body, in the order of their times.
    """
    import numpy as np

    if len(poses) < FEWEST:
        return None
    times = np.array([pose.at for pose in poses], dtype=np.float64)
    points = np.stack([pose.points for pose in poses]).astype(np.float64)
    good = np.isfinite(points).all(axis=(1, 2)) & np.isfinite(times)
    good[1:] &= np.diff(times) > 0
    times, points = times[good], points[good]
    if len(times) < FEWEST or times[-1] - times[0] < SHORTEST:
        return None
    marks, visible = _resampled(times, points)
    if visible[list(SHOULDERS)].min() < PRESENT:
        return None
    marks[..., 1:] *= -1.0  # from the picture's axes (y down, z away) to y up, z to the viewer
    shoulders, hips = marks[:, SHOULDERS].mean(axis=1), marks[:, HIPS].mean(axis=1)
    has_hips = bool(visible[list(HIPS)].min() >= PRESENT)
    across = np.median(marks[:, 11] - marks[:, 12], axis=0)
    width = float(np.linalg.norm(across))
    size = float(np.median(np.linalg.norm(shoulders - hips, axis=1))) if has_hips else width / WIDTH
    if size < 1e-6 or not np.isfinite(size):
        return None
    if has_hips:
        across = across + np.median(marks[:, 23] - marks[:, 24], axis=0)
    angle = float(np.arctan2(across[2], across[0]))
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, 0.0, -sin], [0.0, 1.0, 0.0], [sin, 0.0, cos]])
    arms = marks[:, JOINTS[:ARMS]] - shoulders[:, None]
    legs = marks[:, JOINTS[ARMS:]] - hips[:, None]
    joints = np.concatenate([arms, legs], axis=1) @ turn / size
    present = visible[list(JOINTS)] >= PRESENT
    present[ARMS:] &= has_hips
    rise = (shoulders[:, 1] - shoulders[:, 1].mean()) / size
    return Skeleton(np.clip(joints, -4, 4), present, (shoulders - hips) @ turn / size, np.clip(rise, -4, 4), has_hips)


def _resampled(
    times: NDArray[np.float64], points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the places of the landmarks (T, 33, 3) at `RATE`, and the share of frames in which each is visible (33,).

    While a landmark is invisible, its place is interpolated linearly. The places are smoothed. Unused landmarks get 0.
    """
    import numpy as np

    frames = np.arange(times[0], times[-1], 1 / RATE)
    marks = np.zeros((len(frames), LANDMARKS, 3))
    seen = points[..., 3] >= VISIBLE
    for index in USED:
        here = seen[:, index] if seen[:, index].sum() >= 2 else np.ones(len(times), dtype=bool)
        for axis in range(3):
            marks[:, index, axis] = np.interp(frames, times[here], points[here, index, axis])
    padded = np.concatenate([marks[:1], marks, marks[-1:]])
    return (padded[:-2] + 2 * padded[1:-1] + padded[2:]) / 4, seen.mean(axis=0)
