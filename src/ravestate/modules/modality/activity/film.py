"""A film: the poses of the last seconds."""

from __future__ import annotations

from bisect import bisect_left, bisect_right

from .pose import Pose

LENGTH = 30.0
"""The length of a film, in seconds."""
MOST = 2000
"""The maximum number of poses in a film."""


class Film:
    """The poses of one body in the last `LENGTH` seconds, oldest first. Immutable."""

    __slots__ = ("poses",)

    def __init__(self, poses: tuple[Pose, ...] = ()) -> None:
        self.poses = poses

    def __repr__(self) -> str:
        if not self.poses:
            return "Film()"
        return f"Film({len(self.poses)} poses, {self.poses[-1].at - self.poses[0].at:.1f} s)"

    def with_pose(self, pose: Pose) -> Film:
        """Return the film with one more pose.

        A pose that is older than the film's last pose begins a new film. A pose with the same time as the
        last pose is ignored.
        """
        if self.poses and pose.at <= self.poses[-1].at:
            return self if pose.at == self.poses[-1].at else Film((pose,))
        first = bisect_left(self.poses, pose.at - LENGTH, key=_time)
        return Film((*self.poses[max(first, len(self.poses) - MOST + 1) :], pose))

    def part(self, start: float, end: float) -> tuple[Pose, ...]:
        """Return the poses between two times (seconds)."""
        return self.poses[bisect_left(self.poses, start, key=_time) : bisect_right(self.poses, end, key=_time)]


def _time(pose: Pose) -> float:
    return pose.at
