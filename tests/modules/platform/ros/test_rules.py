"""The rules that connect a context with ROS, and follow the clock of a simulation."""

import asyncio
import itertools
from types import SimpleNamespace
from typing import Any

import pytest

import ravestate as rs
from modules.platform.ros.networks import PATIENCE, Network, until
from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros import Bus, quality
from ravestate.modules.platform.ros.places import Place
from ravestate.modules.platform.ros.rules import follow_clock

ALL = quality(None, depth=10, latch=False)


def test_the_clock_of_the_context_follows_the_clock_of_a_simulation_at_any_speed() -> None:
    agent = rs.Module("agent", requires=[ros2])
    go = agent.signal("go", input=True)
    waited: list[float] = []

    @agent.rule(when=go.min_age(30.0).max_age(60.0))
    async def late(ctx: rs.RuleContext) -> None:
        waited.append(ctx.now)

    async def main() -> None:
        async with Bus(0) as bus, asyncio.timeout(PATIENCE):
            settings = {"backend": "bus", "bus": bus.address}
            world = ros2.make_node(ros2.Settings(**settings))
            clock = world.advertise("/clock", "rosgraph_msgs/Clock", qos=ALL)
            async with rs.Context(agent, settings={"ros2": {**settings, "use_sim_time": True}}) as context:

                def at(seconds: int) -> None:
                    clock.publish({"clock": {"sec": seconds, "nanosec": 500_000_000}})

                await until(lambda: context.read(ros2.node))
                await until(lambda: bus.find("subscriber", "/clock"))
                start = context.now
                times: list[float] = []
                at(100)
                # Without a message, the time of the context does not advance.
                await until(lambda: times.append(context.now) or times[-1:] == times[-2:-1])
                begun = context.now
                assert begun >= start
                context.emit(go)
                at(129)
                await until(lambda: context.now == pytest.approx(begun + 29))
                assert not waited
                at(131)  # the simulated clock may jump
                await until(lambda: waited)
                assert waited == [pytest.approx(begun + 31)]
                later = itertools.count(3)
                await until(lambda: context.now > begun + 31.5, lambda: at(next(later)))
                assert context.now < begun + 31 + next(later)
            await world.close()

    asyncio.run(main())


def test_no_time_is_lost_when_a_simulation_takes_over_the_clock() -> None:
    class SlowContext:
        """A context on a slow machine. Its clock advances at each reading, until a simulation drives it."""

        time, driven = 0.0, False

        @property
        def now(self) -> float:
            self.time += 0.0 if self.driven else 1.0
            return self.time

        def drive_clock(self, time: float) -> None:
            self.time, self.driven = max(self.now, time), True

    class Simulation:
        """A node that receives only the time of a simulation."""

        def subscribe(self, topic: str, type: str, take: Any, **options: Any) -> None:
            self.take = take

        def at(self, seconds: int) -> None:
            self.take(SimpleNamespace(clock=SimpleNamespace(sec=seconds, nanosec=0)))

    ctx: Any = SlowContext()
    simulation: Any = Simulation()
    follow_clock(ctx, simulation)
    simulation.at(100)
    begun = ctx.now
    simulation.at(129)
    assert ctx.now == begun + 29


def test_the_context_follows_a_real_simulation_at_ten_times_the_speed_and_when_halted(either: Network) -> None:
    ros = either.module
    agent = rs.Module("agent", requires=[ros])
    go = agent.signal("go", input=True)
    waited: list[float] = []
    simulated: list[float] = []

    @agent.rule(when=go.min_age(5.0).max_age(60.0))
    async def late(ctx: rs.RuleContext) -> None:
        waited.append(ctx.now)

    def look(message: Any) -> None:
        simulated.append(message.clock.sec + message.clock.nanosec / 1e9)

    async def main() -> None:
        settings = {f"ros{either.version}": {**either.settings[f"ros{either.version}"], "use_sim_time": True}}
        async with either.lent() as world, rs.Context(agent, settings=settings) as context:
            clock = asyncio.get_running_loop().time
            world.subscribe("/clock", "rosgraph_msgs/Clock", look, qos=quality("sensor_data", depth=5, latch=False))
            speed = world.advertise("/speed", "std_msgs/Float32", qos=ALL)
            last = context.now
            await until(lambda: context.read(ros.node))
            made = context.read(ros.node)
            assert made is not None
            await until(lambda: simulated and context.now > last + 5.0, lambda: speed.publish(10.0))
            begun, real = context.now, clock()
            context.emit(go)
            await until(lambda: waited)
            assert waited[0] >= begun + 5.0
            assert context.now - begun > 2 * (clock() - real)  # simulated time passes faster than real time
            speed.publish(0.0)
            halted = len(simulated)
            await until(lambda: len(simulated) > halted + 20 and simulated[-20] == pytest.approx(simulated[-1]))
            stood = context.now
            await until(lambda: len(simulated) > halted + 30)
            assert context.now == pytest.approx(stood)
            speed.publish(10.0)
            await until(lambda: context.now > stood + 1.0)

    either.run(main)


def test_an_agent_without_ros_ends_with_an_error_that_says_what_to_install() -> None:
    agent = rs.Module("agent", requires=[ros2])
    ros2.publisher(agent, "chat", topic="/chat", type="std_msgs/String")

    async def main() -> None:
        settings = {"ros2": {"python": "/nowhere/python", "backend": "rclpy"}}
        async with rs.Context(agent, settings=settings) as context, asyncio.timeout(PATIENCE):
            with pytest.raises(rs.PlatformError, match="/nowhere/python"):
                await context.until_stopped()

    asyncio.run(main())


@pytest.mark.parametrize("kind", ["subscriber", "publisher", "service", "action"])
@pytest.mark.parametrize("ros", [ros1, ros2], ids=["ros1", "ros2"])
def test_an_agent_whose_search_finds_no_ros_ends_with_that_error_alone(
    ros: Any, kind: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def missing(*_: Any) -> Place:
        raise rs.PlatformError("install ROS first")

    name = ros.module.name
    monkeypatch.setattr(f"ravestate.modules.platform.{name}.names.{name}_place", missing)
    agent = rs.Module("agent", requires=[ros])
    if kind in ("subscriber", "publisher"):
        getattr(ros, kind)(agent, "bound", topic="/bound", type="std_msgs/String")
    elif kind == "service":
        ros.service(agent, "bound", service="/bound", type="std_srvs/SetBool")
    else:
        ros.action(agent, "bound", action="/bound", type="actionlib/Test")

    async def main() -> None:
        async with rs.Context(agent) as context, asyncio.timeout(PATIENCE):
            with pytest.raises(rs.PlatformError, match="install ROS first"):
                await context.until_stopped()

    asyncio.run(main())
    assert not caplog.records


def test_an_agent_without_slots_of_ros_needs_no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: Any) -> Place:
        raise rs.PlatformError("install ROS first")

    monkeypatch.setattr("ravestate.modules.platform.ros1.names.ros1_place", missing)

    async def main() -> None:
        async with rs.Context(rs.Module("agent", requires=[ros1])) as context, asyncio.timeout(PATIENCE):
            await until(lambda: context.read(ros1.node))
            context.ask_to_stop()
            await context.until_stopped()

    asyncio.run(main())


def test_messages_from_startup_and_shutdown_are_published() -> None:
    agent = rs.Module("agent", requires=[ros2])
    chat = ros2.publisher(agent, "chat", topic="/chat", type="std_msgs/String")

    @agent.rule(when=rs.startup, writes=chat)
    async def greet(ctx: rs.RuleContext) -> None:
        ctx[chat] = {"data": "hello"}

    @agent.rule(when=rs.shutdown, writes=chat)
    async def leave(ctx: rs.RuleContext) -> None:
        ctx[chat] = {"data": "goodbye"}

    async def main() -> None:
        async with Bus(0) as bus, asyncio.timeout(PATIENCE):
            settings = {"backend": "bus", "bus": bus.address}
            world = ros2.make_node(ros2.Settings(**settings))
            heard: list[Any] = []
            world.subscribe("/chat", "std_msgs/String", lambda message: heard.append(message.data), qos=ALL)
            await until(lambda: bus.find("subscriber", "/chat"))
            async with rs.Context(agent, settings={"ros2": settings}):
                await until(lambda: bus.find("publisher", "/chat"))
            await until(lambda: len(heard) > 1)
            assert heard == ["hello", "goodbye"]
            await world.close()

    asyncio.run(main())
