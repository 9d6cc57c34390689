"""The names of `roboyio`: its settings, its module, its slots and signals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import pydantic

import ravestate as rs
from ravestate.modules import interloc, rawio, ros1, ros2
from ravestate.settings import NameOrPath

if TYPE_CHECKING:
    from .connection import Connection


@dataclass(frozen=True, slots=True)
class Pose:
    """A pose of the head (radians). Positive angles are to the left, up, and towards the left shoulder."""

    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0


class Settings(rs.Settings):
    """The settings of roboyio: the robot, and the connection to it."""

    link: Literal["bus", "ros1", "ros2"] = "bus"
    """``bus`` for the stand-in (a simulated robot on a page), ``ros1`` or ``ros2`` for a robot."""
    robot: NameOrPath = "roboy"
    """``roboy``, ``turtlebot``, or the path of a data file of your own."""
    bus: str = "127.0.0.1:7411"
    """The address of the built-in bus, which replaces ROS for the stand-in."""
    feeling: float = pydantic.Field(5.0, ge=0, allow_inf_nan=False)
    """The face shows a feeling for this many seconds."""
    look_around: float = pydantic.Field(8.0, gt=0, allow_inf_nan=False)
    """The mean number of seconds between two glances of an idle robot."""
    speech_timeout: float = pydantic.Field(60.0, gt=0, allow_inf_nan=False)
    """The longest time (seconds) that a robot with a service for speech may take to speak an utterance."""


module = rs.Module("roboyio", requires=(rawio, interloc, ros1, ros2), settings=Settings)

here = module.flag("here", input=True)
"""Whether the context is the robot's own. An agent that also has a platform with many users has several contexts."""

body: rs.Slot[Connection | None] = module.slot("body", None)
"""The connection to the robot; None if there is none, for example in virtual time."""

words: rs.Slot[str] = module.slot("words", "", type=str, always=True, input=True)
"""The last words that the robot understood."""

direction: rs.Slot[float | None] = module.slot("direction", None, input=True)
"""The direction of the person who speaks (radians, positive to the left); None if nobody has spoken yet."""

expression: rs.Slot[str] = module.slot("expression", "neutral", type=str)
"""The face: ``neutral``, ``happy``, ``shy``, ``surprised``, ``affectionate``, ``sad`` or ``thinking``."""

gaze: rs.Slot[Pose] = module.slot("gaze", Pose(), type=Pose)
"""The pose of the head."""

gesture: rs.Slot[str] = module.slot("gesture", "", type=str, always=True)
"""The last gesture: ``nod``, ``shake`` or ``wave``. A write makes the robot perform it."""

speaking = module.flag("speaking")
"""Whether the robot is speaking."""
