"""Recognise a person's activity, for example waving or rowing, by the movement of their body."""

from __future__ import annotations

from . import rules as rules
from .film import Film
from .names import Activity, Lesson, Settings, in_view, known, label, model, module, movement, posed, recognised, taught
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
    "in_view",
    "known",
    "label",
    "model",
    "module",
    "movement",
    "posed",
    "pose_of",
    "recognised",
    "taught",
]
