"""The agent's eyes: they see faces, recognise people, and notice people who come and go."""

from __future__ import annotations

from . import consent as consent
from . import rules as rules
from .face import FaceVec, Look, Pose
from .frames import Frame, Frames
from .names import Settings, camera, facevec, history, left, looked, module, named, pose, visitors
from .visitors import Visitor

__all__ = [
    "FaceVec",
    "Frame",
    "Frames",
    "Look",
    "Pose",
    "Settings",
    "Visitor",
    "camera",
    "facevec",
    "history",
    "left",
    "looked",
    "module",
    "named",
    "pose",
    "visitors",
]
