"""Cameras: a device, a video file, a folder of pictures. Each returns its newest picture, and skips older ones."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

from . import picture
from .picture import Picture

EACH = 1.0
"""Each picture of a folder is shown for this many seconds."""
SUFFIXES = {".jpg", ".jpeg", ".png", ".webp", ".bmp", ".tif", ".tiff"}
BEHIND = 1.0
"""One call of `Video.picture` may spend at most this many seconds on skipping pictures."""
WHOLE = 0.9
"""A video counts as damaged if less than this share of its pictures is readable."""
SILENT = 5.0
"""A device counts as lost if it delivers no picture for this many seconds."""


def open_camera(source: str, *, loop: bool = False):
    """Open a camera.

    Args:
        source: A device (``/dev/video0`` or its number), a video file, or a folder of pictures.
        loop: Whether a file or a folder begins again at its end.

    Raises:
        OSError, ValueError: The camera cannot be opened; the message says why.
    """
    if source.isdecimal():
        source = f"/dev/video{source}"
    path = Path(source).expanduser()
    if path.is_dir():
        return Folder(path, loop=loop)
    if path.is_char_device():
        return Device(path)
    if path.is_file():
        return Video(path, loop=loop)
    if source.startswith("/dev/"):
        found = ", ".join(sorted(str(one) for one in Path("/dev").glob("video*")))
        raise OSError(
            f"there is no camera {source} ({f'there is {found}' if found else 'there is no /dev/video* at all'})"
        )
    raise OSError(f"there is no camera, video or folder {source}")


class Device:
    """A camera of this machine. A thread reads its pictures, and keeps the newest one."""

    live = True
    ended = False

    def __init__(self, path: Path) -> None:
        import cv2

        self.skipped = 0
        self._path = path
        self._capture = cv2.VideoCapture(str(path))
        if not self._capture.isOpened():
            raise OSError(
                f"the camera {path} cannot be opened: another program may use it, or you lack the right to read it"
            )
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        self._new = threading.Condition()
        self._pixels, self._time, self._fault = None, 0.0, ""
        self._closed = False
        threading.Thread(target=self._take, daemon=True).start()

    def picture(self, _at: float) -> Picture | None:
        """Return the newest picture. If it was already returned, wait for the next picture.

        Raises:
            OSError: The camera delivers no more pictures.
        """
        with self._new:
            self._new.wait_for(lambda: self._pixels is not None or self._fault, SILENT)
            pixels, self._pixels = self._pixels, None
            if pixels is None:
                raise OSError(self._fault or f"the camera {self._path} has given no picture for {SILENT:g} s")
            return Picture(pixels[:, :, ::-1], self._time)

    def close(self) -> None:
        """Release the device."""
        self._closed = True

    def _take(self) -> None:
        while not self._closed:
            good, pixels = self._capture.read()
            with self._new:
                if not good:
                    self._fault = f"the camera {self._path} gives no more pictures: is it unplugged?"
                    self._new.notify()
                    break
                self.skipped += self._pixels is not None
                self._pixels, self._time = pixels, time.monotonic()
                self._new.notify()
        self._capture.release()


class Video:
    """A video file. Its pictures come at the times that the file says."""

    live = False

    def __init__(self, path: Path, *, loop: bool = False) -> None:
        self.ended = False
        self.skipped = 0
        self._path, self._loop = path, loop
        self._begun = 0.0  # the time at which the present round of the loop began
        self._waiting: tuple[float, Any] | None = None
        self._last = 0.0
        self._fault = ""
        self._open()

    def picture(self, at: float) -> Picture | None:
        """Return the newest picture up to a time (seconds since the beginning); None if it was already returned.

        Raises:
            ValueError: The file is damaged.
        """
        newest, begun = None, time.monotonic()
        while self._waiting is not None and self._waiting[0] <= at:
            if newest is not None and time.monotonic() - begun > BEHIND:
                # If decoding takes longer than playing, the video is shown late. Without this limit, each call would skip
                # more pictures than the call before.
                break
            self.skipped += newest is not None
            newest = self._waiting
            self._forward()
        if newest is None:
            if self._fault:
                fault, self._fault = self._fault, ""
                raise ValueError(fault)
            return None
        time_of, pixels = newest
        return Picture(pixels[:, :, ::-1], time_of)

    def close(self) -> None:
        """Close the file."""
        self._capture.release()

    def _open(self) -> None:
        import cv2

        self._capture = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG)
        self._rate = self._capture.get(cv2.CAP_PROP_FPS) or 25.0
        if not self._capture.isOpened():
            raise ValueError(f"{self._path} is not a readable video: is it damaged or still being written?")
        self._count = 0
        self._forward()
        if self._waiting is None:
            raise ValueError(f"the video {self._path} has no readable picture: is it damaged?")

    def _forward(self) -> None:
        import cv2

        good, pixels = self._capture.read()
        if good:
            stamp = self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1000
            place = self._begun + (stamp if stamp > 0 else self._count / self._rate)
            self._last = max(self._last, place)
            self._waiting = self._last, pixels
            self._count += 1
            return
        self._waiting = None
        expected = self._capture.get(cv2.CAP_PROP_FRAME_COUNT)
        if self._count and self._count < WHOLE * expected:
            self._fault = f"the video {self._path} is damaged: {self._count} of {expected:.0f} pictures could be read"
        if self._loop and self._count:
            self._capture.release()
            self._begun = self._last + 1 / self._rate
            self._open()
        else:
            self.ended = True


class Folder:
    """A folder of pictures, shown in the order of their names, each for `EACH` seconds."""

    live = False

    def __init__(self, path: Path, *, loop: bool = False) -> None:
        self.ended = False
        self.skipped = 0
        self._files = sorted(file for file in path.iterdir() if file.suffix.lower() in SUFFIXES)
        if not self._files:
            raise ValueError(f"the folder {path} has no pictures ({', '.join(sorted(SUFFIXES))})")
        self._loop = loop
        self._given = -1

    def picture(self, at: float) -> Picture | None:
        """Return the picture at a time (seconds since the beginning); None if it was already returned.

        Raises:
            OSError: The file cannot be read.
            ValueError: The file is not a picture.
        """
        place = int(at / EACH)
        self.ended = not self._loop and place >= len(self._files)
        place = place if self._loop else min(place, len(self._files) - 1)
        if place <= self._given:
            return None
        self.skipped += place - self._given - 1
        self._given = place
        file = self._files[place % len(self._files)]
        try:
            shown = picture.from_bytes(file.read_bytes())
        except ValueError as error:
            raise ValueError(f"{file}: {error}") from None
        shown.time = place * EACH
        return shown

    def close(self) -> None:
        """Do nothing, because nothing is open."""
