"""The vision worker: the process that reads pictures from a camera, and finds faces and poses in pictures.

It runs in its own environment, and imports nothing from Ravestate. A request is a record and the bytes of a picture:

    {"do": "open", "stream": "a", "source": "/dev/video0" | "walk.mp4" | "photos/", "loop": false}
    {"do": "look", "stream": "a", "want": ["faces", "pose"], "at": 1.5, "known": [{"track": 3, "box": [x, y, w, h], "fresh": true}]}
    {"do": "close", "stream": "a"}

A look without bytes looks at the camera's newest picture, or at the picture of a video or folder at the
time ``at`` (seconds). The answer to ``open`` is ``{"live": true}`` for a device, and ``{"live": false}`` for files. This
is the answer to a look:

    {"picture": [width, height], "dark": false, "pose": [[x, y, z, visibility], ...] | null,
     "faces": [{"box": [x, y, w, h], "track": 3 | null, "quality": 0.8 | null, "vector": [...] | null}],
     "ended": false, "skipped": 0, "waited": 0.02}

The last line is there only for a look at a camera. ``track`` is null for a new face. ``quality`` and ``vector`` are null
if the look has computed no vector for the face. An answer has ``fault`` if a camera or a picture has a fault, or if a
look needs a camera and none is open. If there is no new picture, the answer has no field ``picture``.

`Faces.find` explains the field ``known`` of a look, and two more fields: ``thorough`` and ``most``.

The bytes of a look are an encoded picture (JPEG, PNG), or raw pixels. For raw pixels, the record has
``"shape": [height, width]``. It may have ``"encoding"`` (default ``rgb8``) and ``"step"`` (the length of a row in
bytes).
"""

from __future__ import annotations

import contextlib
import os
import time
from typing import Any

from . import picture
from .cameras import open_camera


def load(config: dict[str, Any]):
    """Load the shared models, and return the function that handles a request.

    Args:
        config: Its item ``want`` lists what requests will ask for: ``faces``, ``pose`` or both.
    """
    with contextlib.suppress(OSError):
        os.nice(10)  # the conversation comes first
    worker = Worker()
    for what in config.get("want", ()):
        worker.load(what)
    return worker.handle


class Worker:
    """The models, and the open streams of pictures."""

    def __init__(self) -> None:
        self._faces: Any = None
        self._streams: dict[str, Stream] = {}

    def load(self, what: str) -> None:
        """Load the models for faces, if `what` is ``faces``. Each stream loads its own model for poses."""
        if what == "faces" and self._faces is None:
            from .faces import Faces

            self._faces = Faces()

    def handle(self, header: dict[str, Any], data: bytes) -> tuple[dict[str, Any], bytes]:
        """Answer a request."""
        name = header.get("stream", "")
        if header["do"] == "close":
            self._streams.pop(name, Stream()).close()
            return {}, b""
        stream = self._streams.setdefault(name, Stream())
        if header["do"] == "open":
            return stream.open(header["source"], loop=header.get("loop", False)), b""
        return self._look(stream, header, data), b""

    def _look(self, stream: Stream, header: dict[str, Any], data: bytes) -> dict[str, Any]:
        answer: dict[str, Any] = {}
        if data:
            try:
                seen = picture.from_bytes(
                    data, header.get("shape"), header.get("encoding", "rgb8"), header.get("step", 0)
                )
            except ValueError as error:
                return {"fault": str(error)}
        else:
            seen, answer = stream.picture(header["at"])
            if seen is None:
                return answer
        answer |= {"picture": [seen.width, seen.height], "dark": seen.dark}
        for what in header["want"]:
            self.load(what)
            answer[what] = (self._faces.find if what == "faces" else stream.pose())(seen, header)
        return answer


class Stream:
    """The state for one agent: its camera, if the worker opened one, and the pose finder, which follows a body."""

    def __init__(self) -> None:
        self._camera: Any = None
        self._pose: Any = None

    def open(self, source: str, *, loop: bool) -> dict[str, Any]:
        """Open a camera. If it cannot be opened, the answer has the fault."""
        self.close()
        try:
            self._camera = open_camera(source, loop=loop)
        except (OSError, ValueError) as error:
            return {"fault": str(error)}
        return {"live": self._camera.live}

    def picture(self, at: float) -> tuple[picture.Picture | None, dict[str, Any]]:
        """Return the camera's newest picture at a time, or None. Also return the first fields of the answer."""
        if self._camera is None:
            return None, {"fault": "no camera is open"}
        before = time.monotonic()
        try:
            seen, fault = self._camera.picture(at), ""
        except (OSError, ValueError) as error:
            seen, fault = None, str(error)
        waited = time.monotonic() - before if self._camera.live else 0.0
        answer = {"ended": self._camera.ended, "skipped": self._camera.skipped, "waited": waited}
        return seen, {**answer, **({"fault": fault} if fault else {})}

    def pose(self):
        """Return the function that finds the body in a picture. It follows the body from picture to picture."""
        if self._pose is None:
            from .pose import Pose

            self._pose = Pose()
        return self._pose.find

    def close(self) -> None:
        """Release the camera."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None
