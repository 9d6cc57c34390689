"""The stand-in robot: a node that offers the topics and services in a robot's data file, and shows their effects."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

from ravestate.modules.platform.ros import Channel, Node, quality

from .robot import Axis, Port, Robot

QUALITY = quality(None, depth=100, latch=False)
RATE = 14.0
"""The stand-in speaks this many characters per second."""
SHORTEST = 0.8
"""An utterance takes at least this many seconds."""
TICK = 0.05
"""The seconds between two steps of a turning axis."""


@dataclass(slots=True)
class Looks:
    """The visible state of the robot.

    Attributes:
        name: The robot's name.
        face: Ravestate's name of the expression.
        yaw, pitch, roll: The head's angles (radians).
        text: The words in the speech bubble; empty if there are none.
        seconds: How many seconds it takes to speak these words.
        gesture: The last gesture and a running number, so that a repeated gesture counts as a change.
        people: The names of the people whom the robot sees.
    """

    name: str
    face: str = "neutral"
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0
    text: str = ""
    seconds: float = 0.0
    gesture: tuple[str, int] = ("", 0)
    people: list[str] = field(default_factory=list[str])


class StandIn:
    """A robot that exists only on a page.

    Args:
        robot: The robot, from its data file.
        node: A node that only the stand-in uses. This class does not close it.
        sleep: A function that waits for some seconds; a test may pass a faster function.

    Raises:
        PlatformError: A type is unknown, or ROS is not installed here.
    """

    def __init__(self, robot: Robot, node: Node, sleep: Callable[[float], Any] = asyncio.sleep) -> None:
        self.robot = robot
        self.looks = Looks(robot.name)
        self._watchers: set[Callable[[dict[str, Any]], None]] = set()
        self._sleep = sleep
        self._tasks: set[asyncio.Task[None]] = set()
        if robot.definitions is not None:
            node.types.definitions.add(robot.definitions)
        self._node = node
        self._senses: dict[str, tuple[Port, Channel]] = {}
        for name, port in (("hear", robot.hear), ("direction", robot.direction), ("people", robot.people)):
            if port is not None:
                port.check(node.types)
                self._senses[name] = port, node.advertise(port.topic, port.type, qos=QUALITY)
        self._take(robot.speak, self._speak)
        self._take(robot.express, self._express)
        self._take(robot.gesture, self._perform)
        for name, axis in robot.head.items():
            self._take(axis, self._turner(name, axis))

    # ------------------------------------------------------------------------------- the visitor's side

    def watch(self, watcher: Callable[[dict[str, Any]], None]) -> Callable[[], None]:
        """Call `watcher` with the fields of `Looks`, now and after each change. Return a function that ends these calls."""
        self._watchers.add(watcher)
        watcher(asdict(self.looks))
        return lambda: self._watchers.discard(watcher)

    def hear(self, text: str, direction: float = 0.0) -> None:
        """Let the robot hear a visitor from a direction (radians, positive: to the robot's left)."""
        if "direction" in self._senses:
            port, channel = self._senses["direction"]
            degrees = getattr(port, "unit", "radians") == "degrees"
            channel.publish(port.pack(round(direction * 57.29578) if degrees else direction))
        if "hear" in self._senses:
            port, channel = self._senses["hear"]
            channel.publish(port.pack(text))

    def see(self, names: list[str]) -> None:
        """Let the robot see these people, and nobody else."""
        self._show(people=names)
        if "people" in self._senses:
            port, channel = self._senses["people"]
            channel.publish(port.pack(", ".join(names)))

    async def close(self) -> None:
        """Cancel the robot's unfinished commands."""
        for task in self._tasks:
            task.cancel()

    # ------------------------------------------------------------------------------- the robot's side

    def _take(self, port: Port | None, act: Callable[[Any], Any]) -> None:
        if port is None:
            return
        port.check(self._node.types)
        if port.service:

            async def serve(request: Any) -> dict[str, Any]:
                await act(port.unpack(request))
                return {"success": True}

            self._node.offer(port.service, port.type, serve)
        else:
            self._node.subscribe(
                port.topic, port.type, lambda message: self._start(act(port.unpack(message))), latest=False, qos=QUALITY
            )

    def _start(self, act: Any) -> None:
        task = asyncio.ensure_future(act)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _speak(self, text: str) -> None:
        seconds = max(SHORTEST, len(text) / RATE)
        self._show(text=text, seconds=seconds)
        try:
            await self._sleep(seconds)
        finally:
            if self.looks.text == text:
                self._show(text="", seconds=0.0)

    async def _express(self, name: str) -> None:
        assert self.robot.express is not None
        known = {theirs: ours for ours, theirs in self.robot.express.faces.items()}
        if name not in known:
            raise ValueError(f"{self.robot.name} has no expression {name!r}: {', '.join(known)}")
        self._show(face=known[name])

    async def _perform(self, name: str) -> None:
        self._show(gesture=(name, self.looks.gesture[1] + 1))

    def _turner(self, name: str, axis: Axis) -> Callable[[float], Any]:
        """Return the function that handles the commands to an axis: angles or speeds."""
        now = asyncio.get_running_loop().time
        speed, since, turns = 0.0, 0.0, False

        def show() -> None:
            nonlocal since
            before, since = since, now()
            if speed:
                self._show(**{name: axis.limited(getattr(self.looks, name) + speed * (since - before))})

        async def turn(value: float) -> None:
            nonlocal speed, turns
            if axis.speed is None:
                self._show(**{name: axis.limited(value)})
                return
            show()
            speed = value
            if turns:
                return
            turns = True
            try:
                while speed:  # a later command may change the speed
                    await self._sleep(TICK)
                    show()
            finally:  # a cancelled axis stands still, and a later command turns it again
                speed, turns = 0.0, False

        return turn

    def _show(self, **changes: Any) -> None:
        for name, value in changes.items():
            setattr(self.looks, name, value)
        looks = asdict(self.looks)
        for watcher in list(self._watchers):
            watcher(looks)
