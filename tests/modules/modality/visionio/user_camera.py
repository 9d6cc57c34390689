"""A stand-in for the camera of a user's page. It has a picture whenever the agent asks for one."""

from __future__ import annotations

from collections.abc import Sequence

from ravestate.modules import rawio
from runtime.on_loop import turns


class UserCamera:
    """A `rawio.Camera` that always shows the same picture.

    Attributes:
        picture: A JPEG picture; None when the camera is off.
        asked: How often the agent has asked for a picture.
        marks: The lists of faces that the agent has marked, in order.
        refused: The reasons for which the agent has turned the camera off.
    """

    def __init__(self, picture: bytes) -> None:
        self.picture: bytes | None = picture
        self.asked = 0
        self.marks: list[list[rawio.Face]] = []
        self.refused: list[str] = []

    async def next(self) -> bytes | None:
        self.asked += 1
        await turns(1)  # a camera takes some time, so let other tasks run
        return self.picture

    def mark(self, faces: Sequence[rawio.Face]) -> None:
        self.marks.append(list(faces))

    def refuse(self, why: str) -> None:
        if self.picture is not None:
            self.picture = None
            self.refused.append(why)
