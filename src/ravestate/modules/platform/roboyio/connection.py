"""A connection to a robot: its topics and services, over one node."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Literal

from ravestate.errors import PlatformError
from ravestate.modules.platform.ros import Channel, Node, quality

from .names import Pose
from .robot import Axis, Port, Robot

QUALITY = quality(None, depth=10, latch=False)
LATCHED = quality("latched", depth=1, latch=True)
NOD = ((0.0, -0.18), (0.25, 0.1), (0.25, -0.12), (0.25, 0.0))
"""A nod: the seconds to wait, and then the pitch to add."""
SHAKE = ((0.0, 0.25), (0.3, -0.25), (0.3, 0.2), (0.3, 0.0))
"""A shake of the head: the seconds to wait, and then the yaw to add."""


class Connection:
    """A connected robot.

    Args:
        robot: The data file's content.
        node: The node; this class does not close it.
        sleep: Waits for seconds on the context's clock.
        speech_timeout: Seconds that speaking an utterance may take.

    Raises:
        PlatformError: A type is unknown, or there is no ROS here.
    """

    def __init__(self, robot: Robot, node: Node, sleep: Callable[[float], Any], speech_timeout: float) -> None:
        self.robot = robot
        self.node = node
        self.turn = asyncio.Lock()
        """Held while the robot speaks: one utterance at a time."""
        self._sleep = sleep
        self._pose = Pose()
        if robot.definitions is not None:
            node.types.definitions.add(robot.definitions)
        self._ports: dict[str, Channel] = {}
        for name, port in (("speak", robot.speak), ("express", robot.express), ("gesture", robot.gesture)):
            if port is not None:
                self._ports[name] = self._open(port, speech_timeout if name == "speak" else 5.0)
        for axis, port in robot.head.items():
            self._ports[axis] = self._open(port, 5.0)

    def listen(self, port: Port | None, take: Callable[[Any], None]) -> None:
        """Call `take` with each message of a topic of the robot, if it has it."""
        if port is not None:
            self.node.subscribe(port.topic, port.type, take, latest=False, qos=QUALITY)

    async def say(self, text: str) -> None:
        """Speak a text. It returns when the robot has spoken, as far as the robot tells.

        Raises:
            PlatformError: The robot does not answer.
        """
        await self._send("speak", self.robot.speak, text)

    async def express(self, name: str) -> None:
        """Show an expression, if the robot has it."""
        if self.robot.express is not None and name in self.robot.express.faces:
            await self._send("express", self.robot.express, self.robot.express.faces[name])

    async def look(self, pose: Pose) -> None:
        """Turn the head to a pose, as far as its axes reach."""
        before, self._pose = self._pose, pose
        moves = [self._turn(name, axis, before, pose) for name, axis in self.robot.head.items()]
        await asyncio.gather(*moves)

    async def perform(self, name: str) -> None:
        """Perform a gesture: the robot's own, or one made of head movements."""
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

    async def _turn(self, name: Literal["yaw", "pitch", "roll"], axis: Axis, before: Pose, pose: Pose) -> None:
        old, new = axis.limited(getattr(before, name)), axis.limited(getattr(pose, name))
        if axis.speed is None:
            await self._send(name, axis, new)
        elif abs(new - old) > 0.01:
            try:
                await self._send(name, axis, axis.speed if new > old else -axis.speed)
                await self._sleep(abs(new - old) / axis.speed)
            finally:
                self._publish(name, axis, 0.0)

    def _open(self, port: Port, timeout: float) -> Channel:
        if port.service:
            return self.node.client(port.service, port.type, timeout=timeout)
        return self.node.advertise(port.topic, port.type, qos=QUALITY)

    async def _send(self, name: str, port: Port | None, value: Any) -> None:
        if port is None:
            return
        if port.service:
            answer = await self._ports[name].call(port.pack(value))
            if getattr(answer, "success", True) is False:
                raise PlatformError(f"{self.robot.name} refused {name} {value!r}")
        else:
            self._publish(name, port, value)

    def _publish(self, name: str, port: Port, value: Any) -> None:
        self._ports[name].publish(port.pack(value))
