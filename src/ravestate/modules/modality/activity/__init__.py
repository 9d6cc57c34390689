"""Recognise what somebody plays, by the movement of their body."""

from __future__ import annotations

from .names import Activity, Lesson, Settings, in_view, known, label, module, posed, poses, recognised, taught
from .pose import Pose

__all__ = [
    "Activity",
    "Lesson",
    "Pose",
    "Settings",
    "in_view",
    "known",
    "label",
    "module",
    "posed",
    "poses",
    "recognised",
    "taught",
]
