"""Draw a figure with a face as a video. The documentation shows this figure instead of a photo of a person.

    python drawn_figure.py FILE.mjpeg

Run it in the environment that `make eyes` sets up, which has OpenCV.
"""

import sys
from typing import Any

import cv2
import numpy as np

SIZE = (480, 640)
SKIN, SHADE, HAIR, SHIRT, WALL, TABLE = (
    (150, 180, 225), (110, 140, 190), (40, 52, 78), (140, 96, 60), (196, 206, 212), (170, 180, 186),
)  # fmt: skip


def figure(x: int = 320, y: int = 215) -> Any:
    """Return the picture (BGR), with the centre of the face at (x, y)."""
    picture = np.full((*SIZE, 3), WALL, np.uint8)
    cv2.rectangle(picture, (0, 330), (640, 480), TABLE, -1)
    cv2.ellipse(picture, (x, y + 255), (170, 140), 0, 180, 360, SHIRT, -1)
    cv2.rectangle(picture, (x - 38, y + 65), (x + 38, y + 135), SHADE, -1)
    cv2.ellipse(picture, (x, y - 28), (108, 120), 0, 0, 360, HAIR, -1)
    cv2.ellipse(picture, (x, y + 5), (88, 112), 0, 0, 360, SKIN, -1)
    cv2.ellipse(picture, (x, y - 92), (86, 44), 0, 180, 360, HAIR, -1)
    for side in (-1, 1):
        cv2.ellipse(picture, (x + side * 90, y + 8), (14, 26), 0, 0, 360, SHADE, -1)
        darken(picture, 0.28, 7, (x + side * 36, y - 16), (26, 17))
        eye = x + side * 36, y - 12
        cv2.ellipse(picture, eye, (19, 9), 0, 0, 360, (245, 245, 245), -1, cv2.LINE_AA)
        cv2.circle(picture, eye, 8, (90, 70, 40), -1, cv2.LINE_AA)
        cv2.circle(picture, eye, 4, (10, 10, 10), -1, cv2.LINE_AA)
        cv2.ellipse(picture, eye, (20, 10), 0, 185, 355, HAIR, 3, cv2.LINE_AA)
        cv2.ellipse(picture, (eye[0], eye[1] - 20), (27, 11), 0, 200, 340, HAIR, 7, cv2.LINE_AA)
        cv2.ellipse(picture, (x + side * 9, y + 41), (5, 3), 0, 0, 360, (60, 80, 120), -1, cv2.LINE_AA)
    darken(picture, 0.35, 5, (x, y + 36), (19, 10))
    darken(picture, 0.2, 6, (x + 13, y + 10), (5, 24))
    cv2.ellipse(picture, (x, y + 64), (36, 14), 0, 10, 170, (90, 90, 180), 5, cv2.LINE_AA)
    return cv2.GaussianBlur(picture, (0, 0), 1.2)


def darken(picture: Any, share: float, soft: float, centre: tuple[int, int], axes: tuple[int, int]) -> None:
    """Darken an ellipse of a picture, with soft edges."""
    shadow = np.zeros(SIZE, np.float32)
    cv2.ellipse(shadow, centre, axes, 0, 0, 360, 1.0, -1)
    picture[:] = picture * (1 - share * cv2.GaussianBlur(shadow, (0, 0), soft)[..., None])


if __name__ == "__main__":
    with open(sys.argv[-1], "wb") as out:
        for _ in range(10):
            out.write(cv2.imencode(".jpg", figure())[1].tobytes())
