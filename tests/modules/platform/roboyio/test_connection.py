"""The connection to a robot turns its base and makes it speak. Wrong fields are refused."""

import asyncio
from typing import Any

import pytest

from modules.platform.ros.networks import PATIENCE, opened, until
from ravestate.errors import PlatformError
from ravestate.modules import roboyio, ros2
from ravestate.modules.platform.roboyio.connection import QUALITY, STEP, Connection
from ravestate.modules.platform.roboyio.robot import Port
from ravestate.modules.platform.ros import Bus
from runtime.on_loop import turns


class Base:
    """A stand-in for a base: it obeys the commands on its topic, and has its own clock."""

    def __init__(self) -> None:
        self.now = self.angle = self.speed = 0.0
        self.longest = 0.0
        self._last = 0.0
        self._marks: list[tuple[float, asyncio.Event]] = []

    def publish(self, message: Any) -> None:
        if self.speed:
            self.longest = max(self.longest, self.now - self._last)
        self._last = self.now
        self.speed = message["angular"]["z"]

    async def sleep(self, seconds: float) -> None:
        """Let time pass on the clock of the base. First, let other waiting tasks run."""
        end = self.now + seconds
        await turns(1)
        self.angle += self.speed * max(0.0, end - self.now)
        self.now = max(self.now, end)
        for angle, event in self._marks:
            if self.angle >= angle:
                event.set()

    async def passes(self, angle: float) -> None:
        self._marks.append((angle, asyncio.Event()))
        await self._marks[-1][1].wait()


async def turtlebot(bus: Bus, base: Base) -> Connection:
    node = ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))
    robot = roboyio.load_robot("turtlebot")
    advertise = node.advertise

    def with_base(topic: str, *arguments: Any, **options: Any) -> Any:
        return base if topic == robot.head["yaw"].topic else advertise(topic, *arguments, **options)

    node.advertise = with_base  # type: ignore[method-assign]  # only the `publish` of a base is used
    made = Connection(robot, node, base.sleep, lambda: base.now, 5.0)
    await made.open()
    return made


def test_a_base_turns_to_the_newest_direction_even_while_it_turns() -> None:
    async def main() -> None:
        async with Bus(0) as bus, asyncio.timeout(PATIENCE):
            base = Base()
            robot = await turtlebot(bus, base)
            first = asyncio.ensure_future(robot.look(roboyio.Pose(yaw=1.0)))
            await base.passes(0.4)
            await robot.look(roboyio.Pose(yaw=-1.0))
            await first
            assert (base.angle, base.speed) == (pytest.approx(-1.0, abs=0.05), 0.0)
            assert base.longest <= STEP + 1e-9  # a real base stops if the next command comes too late
            await robot.look(roboyio.Pose(yaw=0.5))
            assert (base.angle, base.speed) == (pytest.approx(0.5, abs=0.05), 0.0)
            await robot.node.close()

    asyncio.run(main())


def test_a_turn_that_is_cancelled_stops_the_base() -> None:
    async def main() -> None:
        async with Bus(0) as bus, asyncio.timeout(PATIENCE):
            base = Base()
            robot = await turtlebot(bus, base)
            turn = asyncio.ensure_future(robot.look(roboyio.Pose(yaw=3.0)))
            await base.passes(1.0)
            turn.cancel()
            await asyncio.wait((turn,))
            assert base.speed == 0.0
            await robot.look(roboyio.Pose())  # the robot knows the angle at which it stopped
            assert base.angle == pytest.approx(0.0, abs=0.05)
            await robot.node.close()

    asyncio.run(main())


def test_say_waits_until_the_robot_is_connected() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))) as node:
            heard: list[str] = []
            other = ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))
            other.subscribe("/speech/say", "std_msgs/String", lambda message: heard.append(message.data), qos=QUALITY)
            await until(lambda: bus.find("subscriber", "/speech/say"))
            robot = Connection(roboyio.load_robot("turtlebot"), node, Base().sleep, lambda: 0.0, 5.0)
            order: list[str] = []

            async def speak() -> None:
                await robot.say("Welcome!")
                order.append("said")

            async def connect() -> None:
                order.append("connects")
                await robot.open()

            await asyncio.gather(speak(), connect())
            assert order == ["connects", "said"]
            await until(lambda: heard == ["Welcome!"])
            await other.close()

    asyncio.run(main())


def test_the_error_names_a_field_that_the_message_type_does_not_have() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))) as node:
            wrong = Port(topic="/speech/say", type="std_msgs/String", field="dat")
            robot = roboyio.load_robot("turtlebot").model_copy(update={"speak": wrong})
            with pytest.raises(PlatformError, match=r"/speech/say, field 'dat'.* did you mean 'data'"):
                await Connection(robot, node, Base().sleep, lambda: 0.0, 5.0).open()

    asyncio.run(main())
