"""Find the pose of a person in a picture."""

from __future__ import annotations

from typing import Any

from .picture import Picture


class Pose:
    """MediaPipe's landmarks of one body, followed from picture to picture."""

    def __init__(self) -> None:
        from mediapipe.python.solutions.pose import Pose as Landmarks

        self._landmarks = Landmarks(model_complexity=1)

    def find(self, picture: Picture, header: dict[str, Any]) -> list[list[float]] | None:
        """Return 33 landmarks, each (x, y, z, visibility), or None if there is no body.

        x and y are shares of the picture's width and height.

        Args:
            picture: The picture.
            header: The request.
        """
        found = self._landmarks.process(picture.pixels).pose_landmarks
        if found is None:
            return None
        return [[point.x, point.y, point.z, point.visibility] for point in found.landmark]
