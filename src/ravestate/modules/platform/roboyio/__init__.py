"""Robots: an agent hears, speaks, looks and shows its feelings through Roboy, another robot, or a robot on a page."""

from __future__ import annotations

from . import rules as rules
from .names import (
    Pose,
    Settings,
    body,
    direction,
    expression,
    gaze,
    gesture,
    here,
    module,
    speaking,
    words,
)
from .robot import Robot, load_robot
from .serving import serve

__all__ = [
    "Pose",
    "Robot",
    "Settings",
    "body",
    "direction",
    "expression",
    "gaze",
    "gesture",
    "here",
    "load_robot",
    "module",
    "rules",
    "serve",
    "speaking",
    "words",
]
