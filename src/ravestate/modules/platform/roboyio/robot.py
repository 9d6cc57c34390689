"""A robot's data file: the names, types and ranges of its topics and services."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import pydantic

from ravestate.errors import DeclarationError, PlatformError, nearest
from ravestate.modules._yaml import read_text
from ravestate.modules.platform.ros import Binding, Types, quality
from ravestate.yaml_text import load_yaml

ROBOTS = Path(__file__).with_name("robots")


class Port(pydantic.BaseModel):
    """A topic or a service of the robot, and the field of its messages that contains the value."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    topic: str = ""
    """The topic's name; empty for a service."""
    service: str = ""
    """The service's name; empty for a topic."""
    type: str
    """The type of the messages."""
    field: str
    """The name of the field. Dots separate nested fields, as in ``angular.z``."""

    @pydantic.model_validator(mode="after")
    def _one_name(self) -> Port:
        if bool(self.topic) == bool(self.service):
            raise ValueError("write either `topic` or `service`")
        return self

    def check(self, types: Types) -> None:
        """Load the type, and check that it has the field.

        Raises:
            PlatformError: The type is unknown, or does not have the field.
        """
        full = types.require(self.type, "srv" if self.service else "msg")
        try:
            types.message(self.pack(None), f"{full}_Request" if self.service else full)
        except PlatformError as error:
            raise PlatformError(f"the robot's {self.topic or self.service}, field {self.field!r}: {error}") from error

    def pack(self, value: Any) -> dict[str, Any]:
        """Return a message in which the field has this value."""
        for name in reversed(self.field.split(".")):
            value = {name: value}
        return value

    def unpack(self, message: Any) -> Any:
        """Return the value of the field in a message."""
        for name in self.field.split("."):
            message = getattr(message, name)
        return message


class Direction(Port):
    """The topic with the direction of the person who speaks."""

    unit: Literal["radians", "degrees"] = "radians"

    def radians(self, message: Any) -> float | None:
        """Return the direction in a message (radians from -pi to pi; 0: straight ahead, positive: left).

        Return None for NaN and infinity: with these, a sensor says that it has no direction.
        """
        value = float(self.unpack(message))
        if not math.isfinite(value):
            return None
        angle = math.radians(value) if self.unit == "degrees" else value
        return math.atan2(math.sin(angle), math.cos(angle))


class Axis(Port):
    """An axis of the head, or of the whole robot if it has no head."""

    low: float
    """The lowest angle (radians)."""
    high: float
    """The highest angle (radians)."""
    speed: float | None = pydantic.Field(None, gt=0)
    """How fast the axis turns (radians per second), if the field is a speed. None if the field is an angle."""

    def limited(self, angle: float) -> float:
        """Return the nearest angle within the range of the axis."""
        return min(self.high, max(self.low, angle))


class Faces(Port):
    """The topic or service that shows an expression on the face."""

    faces: dict[str, str]
    """Ravestate's name of an expression → the robot's name."""


class Gestures(Port):
    """The topic or service that makes the robot perform a gesture."""

    gestures: dict[str, str]
    """Ravestate's name of a gesture → the robot's name."""


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a robot, and the topic or service to which it is bound."""

    name: str
    binding: Binding


class Robot(pydantic.BaseModel):
    """A robot. A data file leaves out the parts that the robot lacks."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True)

    name: str
    definitions: Path | None = None
    """The folder with the definitions of the robot's messages. The path is relative to the data file."""
    hear: Port | None = None
    direction: Direction | None = None
    people: Port | None = None
    """The topic with the names of the people whom the robot sees, separated by commas."""
    speak: Port | None = None
    express: Faces | None = None
    head: dict[Literal["yaw", "pitch", "roll"], Axis] = pydantic.Field(default_factory=dict[Any, Any])
    """The axes of the head, or of the whole robot if it has no head."""
    gesture: Gestures | None = None

    def parts(self, version: Literal[1, 2]) -> list[Part]:
        """Return the parts of this robot that an agent binds to ROS 1 or ROS 2."""
        senses = {"hear": self.hear, "direction": self.direction, "people": self.people}
        acts = {"speak": self.speak, "express": self.express, **self.head, "gesture": self.gesture}
        found: list[Part] = []
        for name, port in {**senses, **acts}.items():
            if port is not None:
                kind = "service" if port.service else "subscriber" if name in senses else "publisher"
                options = {"qos": quality(None, depth=10, latch=False)}
                binding = Binding(version, kind, port.topic or port.service, port.type, options)
                found.append(Part(f"roboyio:{name}", binding))
        return found


def load_robot(name: str) -> Robot:
    """Return the robot of a data file.

    Args:
        name: ``roboy``, ``turtlebot``, or the path of a file of your own.

    Raises:
        DeclarationError: The file does not exist, or has a fault.
    """
    path = Path(name).expanduser()
    if path.suffix not in (".yaml", ".yml"):
        path = ROBOTS / f"{name}.yaml"
    if not path.is_file():
        known = sorted(file.stem for file in ROBOTS.glob("*.yaml"))
        raise DeclarationError(
            f"roboyio.robot={name!r}: there is no such robot{nearest(name, known)}; write {', '.join(known)}, or the path of "
            "a data file (.yaml)"
        )
    try:
        robot = Robot.model_validate(load_yaml(read_text(path, "robot file"), str(path)))
    except pydantic.ValidationError as error:
        first = error.errors()[0]
        raise DeclarationError(f"{path}: {'.'.join(map(str, first['loc']))}: {first['msg']}") from error
    if robot.definitions is not None:
        robot = robot.model_copy(update={"definitions": (path.parent / robot.definitions).resolve()})
    return robot
