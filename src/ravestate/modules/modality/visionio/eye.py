"""The agent's interface to the vision worker: it makes the worker open a camera and look at pictures."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules._children import process
from ravestate.modules._children.process import Backend, ModelProcess

from .frames import Frame
from .places import MEND, eyes_python

WORKER = Backend(
    Path(__file__).with_name("worker"),
    "visionio",
    "the vision worker",
    lambda reason: f". {MEND}" if "module" in reason else "",
)
PATIENCE = 30.0
"""A look may take at most this many seconds."""

_numbers = itertools.count(1)


class Eye:
    """One stream of pictures in the vision worker. All agents of this process share the worker.

    Args:
        python: The interpreter of the worker; by default, see `eyes_python`.

    Raises:
        PlatformError: There is no interpreter for the worker.
    """

    def __init__(self, python: Path | None = None) -> None:
        self.ended = False
        """Whether a video or a folder has ended."""
        self.skipped = 0
        """How many of the camera's pictures were skipped because newer ones had come."""
        self.waited = 0.0
        """How many seconds the last look waited for the camera."""
        self._process: ModelProcess = process.take(WORKER, {"want": ["faces"]}, eyes_python(python))
        self._stream = str(next(_numbers))
        self._source: tuple[str, bool] | None = None
        self._pid: int | None = None  # the worker's process that has opened the camera

    @property
    def process(self) -> ModelProcess:
        """The worker's process."""
        return self._process

    async def open(self, source: str, *, loop: bool = False) -> bool:
        """Open a camera: a device, a video file, or a folder. Return True for a device, and False for files.

        Raises:
            PlatformError: The camera cannot be opened, or the worker cannot be started.
        """
        self._source = source, loop
        return await asyncio.to_thread(self._open)

    async def look(
        self, want: Sequence[str], request: Mapping[str, Any], *, at: float = 0.0, frame: Frame | None = None
    ) -> dict[str, Any] | None:
        """Look at a picture, or at the camera. Return the worker's answer, or None if there is no new picture.

        Args:
            want: ``faces``, ``pose`` or both.
            request: The known tracks (faces that the agent follows); see the docstring of the worker.
            at: The time of the wanted picture in a video or a folder (seconds since the beginning).
            frame: The picture; None to look at the open camera.

        Raises:
            PlatformError: The picture or the camera has a fault, no camera is open, or the worker has died. The next
                look tries again.
        """
        return await asyncio.to_thread(self.look_now, want, request, at=at, frame=frame)

    def look_now(
        self, want: Sequence[str], request: Mapping[str, Any], *, at: float = 0.0, frame: Frame | None = None
    ) -> dict[str, Any] | None:
        """Do the same as `look`, but block the thread until the answer comes."""
        header: dict[str, Any] = {"do": "look", "stream": self._stream, "want": list(want), "at": at, **request}
        if frame is not None and frame.shape is not None:
            header |= {"shape": list(frame.shape), "encoding": frame.encoding, "step": frame.step}
        if frame is None and (self._pid is None or self._pid != self._process.pid):
            self._open()  # the camera was never open, or a new worker has replaced the old one
        data = b"" if frame is None else frame.data
        if frame is not None and not data:
            raise PlatformError("visionio: the picture is empty")
        answer, _ = self._process.request(header, data, seconds=PATIENCE)
        self.ended = answer.get("ended", False)
        self.skipped = answer.get("skipped", 0)
        self.waited = answer.get("waited", 0.0)
        if "fault" in answer:
            raise PlatformError(f"visionio: {answer['fault']}")
        return answer if "picture" in answer else None

    def reopen(self) -> None:
        """Open the camera again at the next look."""
        self._pid = None

    def close(self) -> None:
        """Close the camera. If no other stream uses the worker, the worker ends."""
        if self._process.busy:  # the event loop must not wait for the end of a look, perhaps of another stream
            threading.Thread(target=self._close, name="visionio-close", daemon=True).start()
        else:
            self._close()

    def _close(self) -> None:
        if process.is_shared(self._process) and self._process.pid is not None:
            with contextlib.suppress(PlatformError):
                self._process.request({"do": "close", "stream": self._stream}, seconds=PATIENCE)
        process.drop(self._process)

    def _open(self) -> bool:
        if self._source is None:
            raise PlatformError("visionio: no camera is open")
        source, loop = self._source
        answer, _ = self._process.request(
            {"do": "open", "stream": self._stream, "source": source, "loop": loop}, seconds=PATIENCE
        )
        if "fault" in answer:
            raise PlatformError(f"visionio: {answer['fault']}")
        self._pid = self._process.pid
        return answer["live"]
