"""A picture in the worker, scaled down for a quick search. It also records the size of the original."""

from __future__ import annotations

import os

os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(1 << 27))  # a small file may unpack to gigabytes

import cv2
import numpy as np

cv2.setNumThreads(1)

LARGEST = 1280
"""A picture is scaled down if its longer side has more pixels than this. Faces of 40 pixels stay recognisable."""
DARK = 6.0
"""A picture counts as black if its mean brightness (0 to 255) is below this value."""


class Picture:
    """A picture.

    Attributes:
        pixels: RGB, (height, width, 3), uint8, scaled down.
        scale: The size of the original divided by the size of `pixels`.
        width, height: The size of the original (pixels).
        dark: Whether the picture is black.
        time: The time of the picture (seconds). It never decreases from one picture of a camera to the next.
    """

    def __init__(self, pixels: np.ndarray, time: float = 0.0) -> None:
        """Scale the pixels (RGB) down if the picture is too large."""
        self.height, self.width = pixels.shape[:2]
        self.scale = max(1.0, max(self.width, self.height) / LARGEST)
        if self.scale > 1.0:
            size = max(1, round(self.width / self.scale)), max(1, round(self.height / self.scale))
            pixels = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
        self.pixels = np.ascontiguousarray(pixels)
        self.dark = bool(self.pixels[::4, ::4].mean() < DARK)
        self.time = time


CHANNELS = {
    "rgb8": (3, None),
    "bgr8": (3, cv2.COLOR_BGR2RGB),
    "rgba8": (4, cv2.COLOR_RGBA2RGB),
    "bgra8": (4, cv2.COLOR_BGRA2RGB),
    "mono8": (1, cv2.COLOR_GRAY2RGB),
}
"""For each encoding of raw pixels, the size of a pixel in bytes and OpenCV's conversion to RGB."""


def from_bytes(data: bytes, shape: list[int] | None = None, encoding: str = "rgb8", step: int = 0) -> Picture:
    """Return the picture in an encoded file, or in raw pixels.

    Args:
        data: The file or the pixels.
        shape: The height and the width of raw pixels; None for a file.
        encoding: A key of `CHANNELS`.
        step: The length in bytes of a row of raw pixels, including padding; 0 if rows have no padding.

    Raises:
        ValueError: The bytes are not a picture.
    """
    if shape is not None:
        height, width = shape
        channels, conversion = CHANNELS[encoding]
        step = step or width * channels
        if not 0 < width * channels <= step or len(data) != height * step:
            raise ValueError(f"{len(data)} bytes are not a picture of {width} x {height} pixels in {encoding}")
        rows = np.frombuffer(data, np.uint8).reshape(height, step)[:, : width * channels]
        pixels = np.ascontiguousarray(rows.reshape(height, width, channels))
        return Picture(pixels if conversion is None else cv2.cvtColor(pixels, conversion))
    try:
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    except cv2.error as error:
        raise ValueError(f"the picture cannot be read: {error.err}") from None
    if pixels is None:
        raise ValueError("the bytes are not a readable picture (JPEG, PNG, WebP, BMP or TIFF)")
    return Picture(cv2.cvtColor(pixels, cv2.COLOR_BGR2RGB))
