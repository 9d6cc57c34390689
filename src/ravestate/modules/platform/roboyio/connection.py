"""A connection to a robot: one node for all its topics and services."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Any, Literal

from ravestate.errors import PlatformError
from ravestate.modules.platform.ros import Channel, Node, quality

from .names import Pose
from .robot import Axis, Port, Robot

QUALITY = quality(None, depth=10, latch=False)
LATCHED = quality("latched", depth=1, latch=True)
STEP = 0.1
"""The seconds between two commands to an axis with speed commands (see `Axis.speed`). Such an axis, for example a wheeled
base, stops if it gets no commands."""
NEAR = 0.03
"""An axis with speed commands has arrived if it is at most this far from its target (radians)."""
NOD = ((0.0, -0.18), (0.25, 0.1), (0.25, -0.12), (0.25, 0.0))
"""A nod: a sequence of waits (seconds), each followed by the angle to add to the pitch (radians)."""
SHAKE = ((0.0, 0.25), (0.3, -0.25), (0.3, 0.2), (0.3, 0.0))
"""A shake of the head: a sequence of waits (seconds), each followed by the angle to add to the yaw (radians)."""


class Connection:
    """A connected robot.

    Args:
        robot: The robot, from its data file.
        node: The node; this class does not close it.
        sleep: A function that waits for some seconds on the context's clock.
        now: A function that returns the time on the context's clock (seconds).
        speech_timeout: If the robot speaks through a service, an utterance may take at most this many seconds.
    """

    def __init__(
        self,
        robot: Robot,
        node: Node,
        sleep: Callable[[float], Any],
        now: Callable[[], float],
        speech_timeout: float,
    ) -> None:
        self.robot = robot
        self.node = node
        self.turn = asyncio.Lock()
        """A lock that lets the robot speak only one utterance at a time."""
        self._sleep = sleep
        self._now = now
        self._speech_timeout = speech_timeout
        self._pose = Pose()
        self._angles: dict[str, float] = {}
        """The estimated angles of the axes with speed commands: the speeds that were sent, multiplied by their times."""
        self._targets: dict[str, float] = {}
        """The angles at which the turning axes must stop."""
        self._ports: dict[str, Channel] = {}
        self._opened = asyncio.Event()

    async def open(self) -> None:
        """Open the topics and services. Until they are open, commands to the robot wait.

        Raises:
            PlatformError: A type is unknown or lacks the field that the data file names, or ROS is not installed here.
        """
        robot = self.robot
        await self.node.prepare()
        if robot.definitions is not None:
            self.node.types.definitions.add(robot.definitions)
        for name, port in (("speak", robot.speak), ("express", robot.express), ("gesture", robot.gesture)):
            if port is not None:
                self._ports[name] = self._open(port, self._speech_timeout if name == "speak" else 5.0)
        for axis, port in robot.head.items():
            # A robot that connects late gets the newest angle, but it must not get an old speed.
            self._ports[axis] = self._open(port, 5.0, LATCHED if port.speed is None else QUALITY)
        self._opened.set()

    def listen(self, port: Port | None, take: Callable[[Any], None]) -> None:
        """Call `take` with each message of a topic, if the robot has the topic.

        Raises:
            PlatformError: The type is unknown, or lacks the field that the data file names.
        """
        if port is not None:
            port.check(self.node.types)
            self.node.subscribe(port.topic, port.type, take, latest=False, qos=QUALITY)

    async def say(self, text: str) -> None:
        """Let the robot speak a text. If it speaks through a service, wait for the answer; a topic gives no answer.

        Raises:
            PlatformError: The robot does not answer, or refuses to speak.
        """
        await self._send("speak", self.robot.speak, text)

    async def express(self, name: str) -> None:
        """Show an expression, if the robot has this expression.

        Raises:
            PlatformError: The robot does not answer, or refuses.
        """
        if self.robot.express is not None and name in self.robot.express.faces:
            await self._send("express", self.robot.express, self.robot.express.faces[name])

    async def look(self, pose: Pose) -> None:
        """Turn the head to a pose, as far as its axes reach."""
        self._pose = pose
        await asyncio.gather(*(self._move(name, axis) for name, axis in self.robot.head.items()))

    async def perform(self, name: str) -> None:
        """Perform a gesture: the robot's own, or a nod or a shake with the head.

        Ignore a gesture that the robot lacks. A head that turns by speed commands cannot nod or shake.
        """
        gesture = self.robot.gesture
        if gesture is not None and name in gesture.gestures:
            await self._send("gesture", gesture, gesture.gestures[name])
            return
        axis: Literal["pitch", "yaw"] = "pitch" if name == "nod" else "yaw"
        if name not in ("nod", "shake") or axis not in self.robot.head or self.robot.head[axis].speed is not None:
            return
        for seconds, angle in NOD if name == "nod" else SHAKE:
            await self._sleep(seconds)
            at = getattr(self._pose, axis) + angle
            await self._send(axis, self.robot.head[axis], self.robot.head[axis].limited(at))

    async def _move(self, name: str, axis: Axis) -> None:
        angle = axis.limited(getattr(self._pose, name))
        if axis.speed is None:
            await self._send(name, axis, angle)
            return
        turns = name in self._targets
        self._targets[name] = angle
        if not turns:
            await self._turn(name, axis, axis.speed)

    async def _turn(self, name: str, axis: Axis, speed: float) -> None:
        """Turn an axis with speed commands until it is at its target. The target may change meanwhile."""
        at = self._angles.get(name, 0.0)
        moved = False
        try:
            while abs(way := self._targets[name] - at) > NEAR:
                velocity = math.copysign(speed, way)
                await self._send(name, axis, velocity)
                moved = True
                began = self._now()
                try:
                    await self._sleep(min(STEP, abs(way) / speed))
                finally:
                    at = self._angles[name] = at + velocity * (self._now() - began)
        finally:
            del self._targets[name]
            if moved:
                self._publish(name, axis, 0.0)

    def _open(self, port: Port, timeout: float, qos: dict[str, Any] = QUALITY) -> Channel:
        port.check(self.node.types)
        if port.service:
            return self.node.client(port.service, port.type, timeout=timeout)
        return self.node.advertise(port.topic, port.type, latch=qos is LATCHED, qos=qos)

    async def _send(self, name: str, port: Port | None, value: Any) -> None:
        if port is None:
            return
        await self._opened.wait()
        if port.service:
            answer = await self._ports[name].call(port.pack(value))
            if getattr(answer, "success", True) is False:
                raise PlatformError(f"{self.robot.name} refused {name} {value!r}")
        else:
            self._publish(name, port, value)

    def _publish(self, name: str, port: Port, value: Any) -> None:
        self._ports[name].publish(port.pack(value))
