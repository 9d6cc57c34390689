"""An agent with a stand-in for a robot, on the built-in bus and on ROS 1, and rules in virtual time."""

import asyncio
from typing import Any

import pytest

import ravestate as rs
from modules.platform.ros.networks import PATIENCE, Network, pause, until
from ravestate.modules import emotion, interloc, rawio, roboyio, ros1, ros2
from ravestate.modules.platform.roboyio.rules import speakable
from ravestate.modules.platform.roboyio.stand_in import StandIn
from ravestate.modules.platform.ros import Bus
from ravestate.testing import simulate


def parrot() -> rs.Module:
    module = rs.Module("parrot", requires=[rawio])

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"You said: {ctx.payload(rawio.input.changed)} 😀"

    @module.rule(when=rs.startup, writes=rawio.output)
    async def welcome(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Welcome!"

    return module


async def quickly(seconds: float) -> None:
    await pause(seconds / 50)


@pytest.mark.parametrize("name", ["roboy", "turtlebot"])
def test_the_agent_hears_through_the_robot_and_controls_its_voice_face_head_and_hand(name: str) -> None:
    seen: list[dict[str, Any]] = []

    async def main() -> None:
        async with Bus(0) as bus, asyncio.timeout(PATIENCE):
            node = ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))
            robot = StandIn(roboyio.load_robot(name), node, quickly)
            robot.watch(seen.append)
            settings = {"roboyio": {"bus": bus.address, "robot": name, "feeling": 0.2}}
            async with rs.Context(roboyio, emotion, parrot(), settings=settings) as context:
                await until(lambda: any(looks["text"] == "Welcome!" for looks in seen))
                ready = roboyio.load_robot(name)
                assert ready.hear is not None
                await until(lambda: bus.find("subscriber", ready.hear.topic))  # type: ignore[union-attr]
                robot.hear("hello", 0.6)
                await until(lambda: any(looks["text"] == "You said: hello" for looks in seen))
                await until(lambda: any(looks["yaw"] == pytest.approx(0.6, abs=0.12) for looks in seen))
                await until(lambda: context.read(rawio.heard) == "You said: hello")
                assert not context.read(roboyio.speaking)
                context.emit(emotion.happy)
                await until(lambda: any(looks["face"] == "happy" for looks in seen))
                await until(lambda: seen[-1]["face"] == "neutral")
                robot.see(["Ada"])
                await until(lambda: "roboyio:Ada" in context.read(interloc.users))
                if name == "roboy":
                    await until(lambda: any(looks["gesture"][0] == "wave" for looks in seen))
                robot.see(crowd := ["Ada", "Eve", "Bob", "Dan", "Cleo", "Ida", "Tom"])
                await until(lambda: len(context.read(interloc.users)) == len(crowd))
                assert list(context.read(interloc.users).values()) == crowd  # in the robot's order
                robot.see([])
                await until(lambda: not context.read(interloc.users))
            await robot.close()
            await node.close()

    asyncio.run(main())


def test_roboy_hears_and_answers_over_real_ros_1(ros1_network: Network) -> None:
    """Over a roscore: text comes in on a topic, and the answer, the expression and the movement of the head go out."""

    async def main() -> None:
        seen: list[dict[str, Any]] = []
        async with ros1_network.lent() as node:
            robot = StandIn(roboyio.load_robot("roboy"), node, quickly)
            robot.watch(seen.append)
            settings = {**ros1_network.settings, "roboyio": {"link": "ros1"}}
            async with rs.Context(roboyio, emotion, parrot(), settings=settings) as context:
                await until(
                    lambda: any("hello" in looks["text"] for looks in seen), lambda: robot.hear("hello", 0.4), 0.5
                )
                # The direction has a separate topic, which can connect later.
                await until(
                    lambda: any(looks["yaw"] == pytest.approx(0.4, abs=0.01) for looks in seen),
                    lambda: robot.hear("hello", 0.4),
                    0.5,
                )
                ours = context.read(ros1.node)
                assert ours is not None
                bound = [channel.name for channel in ours.channels.values()]
                assert len(bound) == len(set(bound))  # no topic or service was bound twice
                context.emit(emotion.surprised)
                await until(lambda: any(looks["face"] == "surprised" for looks in seen))
            await robot.close()

    ros1_network.run(main)


def test_the_robot_looks_at_the_speaker_and_then_shows_thinking_and_later_looks_around() -> None:
    slow = rs.Module("slow", requires=[rawio])

    @slow.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        await ctx.sleep(4.0)
        ctx[rawio.output] = "Done."

    with simulate(roboyio, slow) as sim:
        assert sim.read(roboyio.body) is None
        sim.put(roboyio.direction, 0.5)
        assert sim.read(roboyio.gaze).yaw == 0.5
        sim.put(roboyio.words, "think, please")
        sim.advance(2.0)
        assert sim.read(roboyio.expression) == "thinking"
        sim.advance(3.0)
        assert sim.said == ["Done."]
        assert sim.read(roboyio.expression) == "neutral"
        assert sim.read(roboyio.gaze).yaw == 0.5
        poses: set[Any] = set()
        for _ in range(40):
            sim.advance(1.0)
            poses.add(sim.read(roboyio.gaze))
        assert len(poses) > 2  # the robot looks around


def test_emoji_are_not_spoken() -> None:
    assert speakable("Hello 😀 you!") == "Hello you!"
    assert speakable("😀 ❤️") == ""
