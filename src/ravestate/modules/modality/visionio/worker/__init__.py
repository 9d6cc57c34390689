"""The vision worker: the process that takes pictures from a camera, and finds faces and poses in pictures.

It runs in an environment of its own, and imports nothing from Ravestate. A request is a record and the bytes of a picture:

    {"do": "open", "source": "/dev/video0" | "walk.mp4" | "photos/", "loop": false}
    {"do": "look", "want": ["faces", "pose"], "at": 1.5, "known": [{"track": 3, "box": [x, y, w, h], "fresh": true}]}

A look without bytes looks at the camera's newest picture, or at a video's picture at the time ``at``. With bytes, it
looks at them: an encoded picture (JPEG, PNG), or raw pixels if the record has ``"shape": [height, width]`` (RGB).
"""

# pyright: basic
from __future__ import annotations

import contextlib
import os
from typing import Any

from . import picture
from .cameras import open_camera


def load(config: dict[str, Any]):
    """Load the models that are always wanted; return the function that handles a request.

    Args:
        config: ``want``: what will be asked for, ``faces`` or ``pose`` or both.
    """
    with contextlib.suppress(OSError):
        os.nice(10)  # the conversation comes first
    worker = Worker()
    for what in config.get("want", ()):
        worker.finder(what)
    return worker.handle


class Worker:
    """The models, and the open camera."""

    def __init__(self) -> None:
        self._finders: dict[str, Any] = {}
        self._camera: Any = None

    def finder(self, what: str):
        """Return the function that finds faces or a pose in a picture. The first call loads its models."""
        if what not in self._finders:
            if what == "faces":
                from .faces import Faces

                self._finders[what] = Faces().find
            else:
                from .pose import Pose

                self._finders[what] = Pose().find
        return self._finders[what]

    def handle(self, header: dict[str, Any], data: bytes) -> tuple[dict[str, Any], bytes]:
        """Answer a request."""
        if header["do"] == "open":
            self._close()
            self._camera = open_camera(header["source"], loop=header.get("loop", False))
            return {"live": self._camera.live, "size": None}, b""
        if header["do"] == "close":
            self._close()
            return {}, b""
        return self._look(header, data), b""

    def _close(self) -> None:
        if self._camera is not None:
            self._camera.close()
            self._camera = None

    def _look(self, header: dict[str, Any], data: bytes) -> dict[str, Any]:
        if data:
            seen, camera = picture.from_bytes(data, header.get("shape")), {}
        else:
            seen = self._camera.picture(header["at"])
            camera = {"ended": self._camera.ended, "skipped": self._camera.skipped}
            if seen is None:
                return {"picture": None, **camera}
        answer: dict[str, Any] = {"picture": [seen.width, seen.height], "dark": seen.dark, **camera}
        for what in header["want"]:
            answer[what] = self.finder(what)(seen, header)
        return answer
