"""Pictures from the user's camera, and the faces that the agent sees in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True)
class Face:
    """A face that the agent sees in a picture of the user's camera.

    Attributes:
        box: x, y, width and height, as shares of the picture's width and height. (0, 0) is the upper left corner.
        name: The person's name; empty if the agent does not know it.
    """

    box: tuple[float, float, float, float]
    name: str = ""


class Camera(Protocol):
    """The camera of a user. The agent asks for each picture, so it gets only as many pictures as it can look at.

    A platform whose users have cameras, for example a web page, puts a camera into `rawio.camera`. A module that looks
    at pictures, such as `visionio`, asks the camera for them.
    """

    async def next(self) -> bytes | None:
        """Ask for a picture, and wait for it. Return a JPEG, or None if the camera is off."""
        ...

    def mark(self, faces: Sequence[Face]) -> None:
        """Show the user the faces that the agent sees now."""
        ...

    def refuse(self, why: str) -> None:
        """Turn the camera off, and tell the user why. A camera that is off stays off."""
        ...
