"""The camera in a visitor's browser as the agent's `rawio.camera`."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from ravestate.modules import rawio

from .frames import Face
from .line import uses

if TYPE_CHECKING:
    from ravestate.policy.policy import Policy

MOST_FACES = 50
"""The maximum number of faces that the page shows."""


class Window(Protocol):
    """A browser window of the visitor, which can have the camera."""

    def wake(self) -> None:
        """Note that the agent wants a picture, or that the visible faces have changed."""
        ...

    def lose_camera(self, why: str) -> None:
        """Note that the window has lost the camera, and why."""
        ...


def sees(policy: Policy) -> bool:
    """Return whether the agent can see: whether a rule of its policy uses `rawio.camera`."""
    return uses(policy, rawio.camera)


class PageCamera:
    """The camera of one browser window: a `rawio.Camera`. It keeps at most one picture, until the agent fetches it.

    The window sends one picture for each request of the agent. So the agent's own pace sets the rate, and no pictures
    pile up if the network is slow or the agent is busy.

    Args:
        window: The window whose camera is on.
    """

    def __init__(self, window: Window) -> None:
        self.window = window
        """The window whose camera is on."""
        self.asked = 0
        """The number of the agent's last request for a picture."""
        self.waits = False
        """Whether the agent is waiting for the picture of request number `asked`."""
        self.faces: tuple[Face, ...] = ()
        """The faces that the agent sees now."""
        self.closed = False
        """Whether the camera is off."""
        self._picture: bytes | None = None
        self._changed = asyncio.Event()

    def __repr__(self) -> str:
        return f"camera of a web page, {'off' if self.closed else 'on'}"

    # -------------------------------------------------------------------------------- the agent's side

    async def next(self) -> bytes | None:
        """Ask for a picture, and wait for it. Return a JPEG, or None if the camera is off."""
        if not self.waits and self._picture is None and not self.closed:
            self.asked += 1
            self.waits = True
            self.window.wake()
        while self._picture is None and not self.closed:
            self._changed.clear()
            await self._changed.wait()
        picture, self._picture = self._picture, None
        return None if self.closed else picture

    def mark(self, faces: Sequence[rawio.Face]) -> None:
        """Show the visitor the faces that the agent sees now."""
        shown = tuple(_face(face) for face in faces[:MOST_FACES])
        if shown != self.faces and not self.closed:
            self.faces = shown
            self.window.wake()

    def refuse(self, why: str) -> None:
        """Turn the camera off, and tell the visitor why."""
        if not self.closed:
            self.close()
            self.window.lose_camera(why)

    # -------------------------------------------------------------------------------- the window's side

    def take(self, number: int, picture: bytes) -> None:
        """Accept the picture that answers request `number`; ignore it if the agent does not wait for it."""
        if self.waits and number == self.asked:
            self.waits = False
            self._picture = picture
            self._changed.set()

    def close(self) -> None:
        """Turn the camera off, and drop its picture."""
        self.closed = True
        self.waits = False
        self._picture = None
        self._changed.set()


def _face(face: rawio.Face) -> Face:
    x, y, width, height = face.box
    left, top = _share(x), _share(y)
    box = left, top, _share(min(x + width, 1.0) - left), _share(min(y + height, 1.0) - top)
    return Face(box, face.name or None)


def _share(value: float) -> float:
    return round(min(max(value, 0.0), 1.0), 4)
