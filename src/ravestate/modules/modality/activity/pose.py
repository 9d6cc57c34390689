"""A pose: the landmarks of one body in one frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ravestate.errors import PlatformError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LANDMARKS = 33
"""The number of landmarks of a body, in the order of MediaPipe's pose model."""


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """The landmarks of one body at one time. Two poses are equal only if they are the same object.

    Raises:
        PlatformError: The points are not numbers of the shape (33, 4).
    """

    at: float
    """Seconds, on the context's clock or since the beginning of the video."""
    points: NDArray[np.float32]
    """Shape (33, 4): x to the right, y down, z away from the camera, and visibility (0 to 1). All three axes have the
    same unit, for example the height of the picture."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", checked(self.points))


def pose_of(points: object, at: float, width: float, height: float) -> Pose:
    """Return a pose from MediaPipe's landmarks, whose places are shares of the picture's size.

    Args:
        points: 33 landmarks, each x, y, z and visibility.
        at: The time of the frame, in seconds.
        width, height: The size of the picture, in pixels.

    Raises:
        PlatformError: The points are not numbers of the shape (33, 4).
    """
    import numpy as np

    return Pose(at, checked(points) * np.array([width / height, 1.0, width / height, 1.0], dtype=np.float32))


def checked(points: object) -> NDArray[np.float32]:
    """Return landmarks as an array of shape (33, 4).

    Raises:
        PlatformError: The points are not numbers of this shape.
    """
    import numpy as np

    try:
        array = np.asarray(points, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise PlatformError(f"landmarks must be numbers, of shape ({LANDMARKS}, 4): {error}") from None
    if array.shape != (LANDMARKS, 4):
        raise PlatformError(f"landmarks have the shape {array.shape}: give ({LANDMARKS}, 4): x, y, z, visibility")
    return array
