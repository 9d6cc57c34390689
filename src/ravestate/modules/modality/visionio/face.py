"""The records of sight: a face, the pose of a body, and one look at a picture."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from ravestate.errors import PlatformError
from ravestate.modules.meta.ontology import Node

Box = tuple[int, int, int, int]
"""x, y, width and height (pixels of the picture), from the picture's upper left corner."""

NUMBERS = 128

Vector = tuple[float, ...]
"""A face as `NUMBERS` finite numbers. The Euclidean distance of two vectors shows whether they belong to the same person."""


@dataclass(frozen=True, slots=True, eq=False)
class FaceVec:
    """A face in a picture.

    Attributes:
        vector: The newest vector of this track.
        box: x, y, width and height (pixels).
        track: The number of the track, which follows the same face from picture to picture.
        person: The person in memory whose stored face is close enough; None if no person is close enough.
        distance: The Euclidean distance to that person's nearest stored vector; None if `person` is None.
        quality: The visibility of the face in the picture from which `vector` comes (0 to 1).
        fresh: Whether `vector` comes from this picture, and not from an earlier one.
        time: The time of the picture (seconds on the context's clock); None, or a time in the future, means now.

    Raises:
        PlatformError: The vector does not consist of 128 finite numbers.
    """

    vector: Vector
    box: Box
    track: int
    person: Node | None = None
    distance: float | None = None
    quality: float = 1.0
    fresh: bool = True
    time: float | None = None

    def __post_init__(self) -> None:
        if len(self.vector) != NUMBERS or not all(map(isfinite, self.vector)):
            found = f"{len(self.vector)} numbers" if len(self.vector) != NUMBERS else "a number that is not finite"
            raise PlatformError(f"visionio: the vector of a face has {found}: give it {NUMBERS} finite numbers")

    def __repr__(self) -> str:
        who = self.person.get("name") if self.person else None
        return f"FaceVec(track={self.track}, person={who!r}, distance={self.distance}, box={self.box}, quality={self.quality})"


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A body in a picture.

    Attributes:
        landmarks: 33 points, each x, y, z and visibility; None if there is no body. x and y are shares of the picture's
            width and height.
        time: The time of the picture (seconds on the context's clock).
    """

    landmarks: tuple[tuple[float, float, float, float], ...] | None
    time: float

    def __repr__(self) -> str:
        return f"Pose({'no body' if self.landmarks is None else f'{len(self.landmarks)} landmarks'}, time={self.time})"


@dataclass(frozen=True, slots=True)
class Look:
    """A look at a picture.

    Attributes:
        time: The time of the picture (seconds on the context's clock).
        size: The picture's width and height (pixels).
        tracks: The track numbers of the faces in the picture.
        dark: Whether the picture is black.
        dropped: How many pictures so far were skipped because newer ones had come.
    """

    time: float
    size: tuple[int, int]
    dark: bool = False
    dropped: int = 0
    tracks: tuple[int, ...] = ()
