"""Recognise what somebody plays, by the movement of their body."""

from __future__ import annotations

from .film import Film
from .names import Activity, Lesson, Settings, film, in_view, known, label, module, posed, recogniser, recognised, taught
from .pose import Pose, pose_of
from .recogniser import Recogniser, Recognition

__all__ = [
    "Activity",
    "Film",
    "Lesson",
    "Pose",
    "Recogniser",
    "Recognition",
    "Settings",
    "film",
    "in_view",
    "known",
    "label",
    "module",
    "posed",
    "pose_of",
    "recogniser",
    "recognised",
    "taught",
]
