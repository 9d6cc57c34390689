"""Split a long movement into windows of a few seconds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .pose import Pose
from .skeleton import SHORTEST


def windows(poses: Sequence[Pose], length: float, step: float) -> Iterator[tuple[Pose, ...]]:
    """Yield windows of a movement. A movement that is shorter than a window is one window.

    A window after the first one is left out if its poses span less than `SHORTEST` seconds.

    Args:
        poses: The poses, in the order of their times.
        length: The length of a window, in seconds.
        step: The seconds from the beginning of one window to the beginning of the next.
    """
    if not poses:
        return
    begin, end = poses[0].at, poses[-1].at
    number = 0
    while True:
        start = begin + number * step
        part = tuple(pose for pose in poses if start <= pose.at <= start + length)
        if part and (number == 0 or part[-1].at - part[0].at >= SHORTEST):
            yield part
        if start + length >= end:
            return
        number += 1
