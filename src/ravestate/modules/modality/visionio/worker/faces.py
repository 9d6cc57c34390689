"""Find the faces in a picture, and compute their boxes, their visibility and their vectors."""

from __future__ import annotations

import contextlib
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import cv2
import dlib
import numpy as np

from .picture import Picture

SURE = 0.5
"""A face that MediaPipe finds counts if its confidence is at least this."""
SAME = 0.3
"""Two boxes with at least this overlap (intersection over union) belong to the same face."""
MOST = 3
"""A look computes at most this many vectors, unless the request says otherwise."""
WITHIN = 0.6
"""Two boxes belong to the same face if at least this share of the smaller box is inside the other one."""
LAP = 0.2
"""A thorough look also searches tiles: parts of the picture. Neighbouring tiles share this part of a tile."""
HOG = 960
"""For dlib's detector, the longer side of a picture is scaled to this many pixels, or to twice as many for a thorough
look. In the scaled picture, the detector finds faces of at least 80 pixels."""
FACE = 110
"""To refine the box of a face, the face is scaled to this width (pixels)."""


class Faces:
    """The models: MediaPipe's detector if it is installed, dlib's detector, and dlib's models for landmarks and
    vectors.

    Raises:
        ImportError: A package is missing.
        FileNotFoundError: A model file of dlib is missing.
    """

    def __init__(self) -> None:
        # Do not import the package: it imports a module that new versions of setuptools lack.
        spec = find_spec("face_recognition_models")
        if spec is None or not spec.submodule_search_locations:
            raise ImportError("No module named 'face_recognition_models'")
        models = Path(spec.submodule_search_locations[0]) / "models"
        for name in ("shape_predictor_5_face_landmarks.dat", "dlib_face_recognition_resnet_model_v1.dat"):
            if not (models / name).is_file():
                raise FileNotFoundError(f"the model file {models / name} is missing")
        self._landmarks = dlib.shape_predictor(str(models / "shape_predictor_5_face_landmarks.dat"))
        self._encoder = dlib.face_recognition_model_v1(str(models / "dlib_face_recognition_resnet_model_v1.dat"))
        self._hog = dlib.get_frontal_face_detector()
        self._fast: Any = None
        with contextlib.suppress(ImportError):
            from mediapipe.python.solutions.face_detection import FaceDetection

            self._fast = FaceDetection(model_selection=1, min_detection_confidence=SURE)

    def find(self, picture: Picture, header: dict[str, Any]) -> list[dict[str, Any]]:
        """Return the faces, the largest first, with boxes in pixels of the original picture.

        Args:
            picture: The picture.
            header: The request. ``known`` has the tracks (faces that the agent follows) with their last boxes. A
                ``fresh`` track needs no vector. If ``thorough`` is 1 or 2, also look for small faces. ``most`` is the
                maximum number of vectors to compute.
        """
        boxes = self._boxes(picture, thorough=int(header.get("thorough", 0)))
        boxes.sort(key=lambda box: -box[2] * box[3])
        known = header.get("known", ())
        tracks = assign([[side * picture.scale for side in box] for box in boxes], [one["box"] for one in known])
        left = header.get("most", MOST)
        found = []
        for box, number in zip(boxes, tracks, strict=True):
            track = None if number is None else known[number]
            face: dict[str, Any] = {
                "box": [round(side * picture.scale) for side in box],
                "track": None if track is None else track["track"],
                "quality": None,
                "vector": None,
            }
            if left and not (track is not None and track.get("fresh")):
                left -= 1
                face["quality"], face["vector"] = self._encode(picture.pixels, box)
            found.append(face)
        return found

    def _boxes(self, picture: Picture, *, thorough: int) -> list[list[float]]:
        pixels = picture.pixels
        height, width = pixels.shape[:2]
        boxes: list[list[float]] = []
        if self._fast is None:
            scale = max(width, height) / (HOG * (1 + bool(thorough)))
            found = self._hog(cv2.resize(pixels, (round(width / scale), round(height / scale))), 0)
            return [[side * scale for side in (one.left(), one.top(), one.width(), one.height())] for one in found]
        for count in range(1, 2 + thorough):  # MediaPipe sees small faces in tiles of the picture
            across, down = (round(side / (count * (1 - LAP) + LAP)) for side in (width, height))
            for place in range(count * count):
                left = place % count * (width - across) // max(1, count - 1)
                top = place // count * (height - down) // max(1, count - 1)
                tile = np.ascontiguousarray(pixels[top : top + down, left : left + across])
                for one in self._fast.process(tile).detections or ():
                    part = one.location_data.relative_bounding_box
                    box = [left + part.xmin * across, top + part.ymin * down, part.width * across, part.height * down]
                    if any(is_part(box, other) for other in boxes):
                        continue
                    if count == 1 or self._refined(pixels, box)[0]:  # in tiles, MediaPipe finds false faces
                        boxes.append(box)
        return boxes

    def _encode(self, pixels: np.ndarray, box: list[float]) -> tuple[float, list[float]]:
        """Return the visibility of a face (0 to 1), and its vector."""
        frontal, rectangle = self._refined(pixels, box)
        shape = self._landmarks(pixels, rectangle)
        chip = dlib.get_face_chip(pixels, shape, 150, 0.25)
        vector = self._encoder.compute_face_descriptor(chip)
        quality = visibility(np.array([[point.x, point.y] for point in shape.parts()], float), chip)
        return round(quality * (1.0 if frontal else 0.5), 3), [round(number, 6) for number in vector]

    def _refined(self, pixels: np.ndarray, box: list[float]) -> tuple[bool, dlib.rectangle]:
        """Return whether dlib sees a frontal face in a box, and the refined box for dlib's landmarks."""
        x, y, width, height = box
        left, top = max(0, int(x - width / 2)), max(0, int(y - height / 2))
        crop = pixels[top : int(y + 1.5 * height), left : int(x + 1.5 * width)]
        if crop.size:
            scale = FACE / max(width, 1.0)
            size = max(1, round(crop.shape[1] * scale)), max(1, round(crop.shape[0] * scale))
            found = self._hog(
                cv2.resize(crop, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR), 0
            )
            boxes = [
                [left + one.left() / scale, top + one.top() / scale, one.width() / scale, one.height() / scale]
                for one in found
            ]
            best = max(boxes, key=lambda one: overlap(one, box), default=box)
            if boxes and overlap(best, box) >= SAME:
                return True, _rectangle(best)
        return False, _rectangle(box)


def visibility(landmarks: np.ndarray, chip: np.ndarray) -> float:
    """Return the visibility of a face (0 to 1), from its size, direction, sharpness and light.

    Args:
        landmarks: dlib's five landmarks: the corners of one eye, of the other eye, and the nose; (5, 2), pixels.
        chip: The face, upright, 150 x 150 pixels, RGB.
    """
    one, other, nose = landmarks[:2].mean(0), landmarks[2:4].mean(0), landmarks[4]
    between = other - one
    distance = float(np.hypot(*between))
    if distance < 1:
        return 0.0
    aside = abs(float(np.dot(nose - one, between)) / distance**2 - 0.5)
    grey = cv2.cvtColor(chip, cv2.COLOR_RGB2GRAY)
    sharp = float(cv2.Laplacian(grey, cv2.CV_64F).var())
    parts = (
        (distance - 8) / 22,  # 30 pixels between the eyes are enough
        (0.45 - aside) / 0.3,  # 0: the nose is in the middle; 0.5: a profile
        sharp / 40,
        (float(grey.std()) - 8) / 20,
    )
    return float(np.prod([min(1.0, max(0.0, part)) for part in parts]))


def assign(boxes: list[list[float]], known: list[list[float]]) -> list[int | None]:
    """Return for each box the index of the known box with the greatest overlap, or None for a new face.

    Each known box belongs to at most one box.
    """
    pairs = [(overlap(box, other), i, j) for i, box in enumerate(boxes) for j, other in enumerate(known)]
    taken: dict[int, int] = {}
    for share, i, j in sorted(pairs, key=lambda pair: -pair[0]):
        if share >= SAME and i not in taken and j not in taken.values():
            taken[i] = j
    return [taken.get(i) for i in range(len(boxes))]


def is_part(one: list[float], other: list[float]) -> bool:
    """Return whether two boxes belong to one face, even if one box shows only a part of the face."""
    shared = _shared(one, other)
    return overlap(one, other) >= SAME or shared >= WITHIN * min(one[2] * one[3], other[2] * other[3])


def overlap(one: list[float], other: list[float]) -> float:
    """Return the intersection over union of two boxes (x, y, width, height)."""
    shared = _shared(one, other)
    return shared / (one[2] * one[3] + other[2] * other[3] - shared) if shared else 0.0


def _shared(one: list[float], other: list[float]) -> float:
    width = min(one[0] + one[2], other[0] + other[2]) - max(one[0], other[0])
    height = min(one[1] + one[3], other[1] + other[3]) - max(one[1], other[1])
    return width * height if width > 0 and height > 0 else 0.0


def _rectangle(box: list[float]) -> dlib.rectangle:
    x, y, width, height = (round(side) for side in box)
    return dlib.rectangle(x, y, x + width, y + height)
