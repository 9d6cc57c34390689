"""Slots for topics, services and actions, in whole agents on real networks."""

import asyncio
import logging
from collections.abc import Iterator
from typing import Any

import pytest

import ravestate as rs
from modules.platform.ros.networks import OWN, PATIENCE, Network, free_port, opened, the_loop, until
from ravestate.errors import PlatformError
from ravestate.modules import ros1, ros2
from ravestate.modules.platform.ros import Bus, quality
from ravestate.testing import simulate


class Everything:
    """An agent with slots for ROS 1 and ROS 2. The tests of this file share it."""

    def __init__(self) -> None:
        agent = self.module = rs.Module("agent")
        self.heard: dict[int, list[str]] = {1: [], 2: []}
        self.lit: dict[int, list[str]] = {1: [], 2: []}
        self.fed: list[Any] = []
        self.failures: list[str] = []
        self.ended: list[str] = []
        self.results: list[list[int]] = []
        self.interrupted: list[bool] = []
        self.ticked: list[float] = []
        self.back: dict[int, rs.Slot[Any]] = {}
        self.chat: dict[int, rs.Slot[Any]] = {}
        self.silent: dict[int, Any] = {}
        for version, ros in ((1, ros1), (2, ros2)):
            self._talk(version, ros)
        self.tick = agent.signal("tick", input=True)
        self.go = {way: agent.signal(f"go_{n}", input=True) for n, way in enumerate((*WAYS, "to the end"))}
        self.stop = agent.signal("stop", input=True)
        options = {"action": "/count", "type": "test_msgs/Fibonacci", "timeout": 15}
        self.count: Any = ros2.action(agent, "count", **options)
        self.guarded: Any = ros2.action(agent, "guarded", **options, until=self.stop)

        self.steps: Any = ros1.action(
            agent, "steps", action="/steps", type="actionlib/Test", timeout=15, until=self.stop
        )
        for version, ros in ((1, ros1), (2, ros2)):
            self._note_the_end(version, ros)

        @agent.rule(when=self.go["ROS 1"], writes=self.steps)
        async def start_steps(ctx: rs.RuleContext) -> None:
            ctx[self.steps] = {"goal": 1000}

        @agent.rule(when=self.tick)
        async def note(ctx: rs.RuleContext) -> None:
            self.ticked.append(ctx.now)

        @agent.rule(when=self.go["the writer's until"], writes=self.count, until=self.stop)
        async def start(ctx: rs.RuleContext) -> None:
            ctx[self.count] = {"order": 1000}

        @agent.rule(when=self.go["the slot's until"], writes=self.guarded)
        async def start_guarded(ctx: rs.RuleContext) -> None:
            ctx[self.guarded] = {"order": 1000}

        @agent.rule(when=self.go["perform"], writes=self.count, until=self.stop)
        async def perform(ctx: rs.RuleContext) -> None:
            try:
                await ros2.perform(ctx, self.count, {"order": 1000})
            except asyncio.CancelledError:
                self.interrupted.append(True)
                raise

        @agent.rule(when=self.go["to the end"], writes=self.count)
        async def finish(ctx: rs.RuleContext) -> None:
            result = await ros2.perform(ctx, self.count, {"order": 5})
            self.results.append(list(result.sequence))

        @agent.rule(when=self.count.feedback | self.guarded.feedback | self.steps.feedback)
        async def follow(ctx: rs.RuleContext) -> None:
            self.fed.append(ctx.now)

        @agent.rule(when=self.count.failed)
        async def fail(ctx: rs.RuleContext) -> None:
            self.failures.append(ctx.payload(self.count.failed))

    def _note_the_end(self, version: int, ros: Any) -> None:
        cancelled = ros.subscriber(
            self.module, f"cancelled{version}", topic="/cancelled", type="std_msgs/String", latch=True
        )

        @self.module.rule(when=cancelled.changed, name=f"end{version}")
        async def end(ctx: rs.RuleContext) -> None:
            self.ended.append(ctx.payload(cancelled.changed).data)

    def _talk(self, version: int, ros: Any) -> None:
        agent = self.module
        # The settings remap these names to /back and /chat.
        back = self.back[version] = ros.subscriber(
            agent, f"back{version}", topic="answers", type="std_msgs/String", keep="all"
        )
        self.chat[version] = ros.publisher(agent, f"chat{version}", topic="~ask", type="std_msgs/String")
        lamp = ros.service(agent, f"lamp{version}", service="/lamp", type="std_srvs/SetBool", timeout=10)
        self.silent[version] = ros.service(
            agent, f"silent{version}", service="/silent", type="std_srvs/SetBool", timeout=0.3
        )

        @agent.rule(when=back.changed, writes=lamp, name=f"switch{version}")
        async def switch(ctx: rs.RuleContext) -> None:
            self.heard[version].append(ctx.payload(back.changed).data)
            ctx[lamp] = {"data": True}

        @agent.rule(when=lamp.changed, name=f"light{version}")
        async def light(ctx: rs.RuleContext) -> None:
            self.lit[version].append(ctx.payload(lamp.changed).message)


WAYS = ["the writer's until", "the slot's until", "perform", "ROS 1"]
NAMES = {"namespace": "/robot", "remap": {"answers": "/back", "~ask": "/chat"}}


@pytest.fixture(scope="module")
def running(ros1_network: Network, ros2_network: Network) -> Iterator[tuple[Everything, rs.Context]]:
    agent = Everything()
    settings = {
        "ros1": {**ros1_network.settings["ros1"], **NAMES, "definitions": [str(OWN)]}, "ros2": {**ros2_network.settings["ros2"], **NAMES},
    }  # fmt: skip
    context = rs.Context(agent.module, settings=settings)
    the_loop().run(context.start())
    yield agent, context
    the_loop().run(context.stop())


@pytest.mark.parametrize("version", [1, 2])
def test_an_agent_publishes_a_text_and_calls_a_service_after_the_answer(
    running: tuple[Everything, rs.Context], ros1_network: Network, version: int
) -> None:
    agent, context = running

    async def main() -> None:
        await until(lambda: agent.heard[version], lambda: context.put(agent.chat[version], {"data": "hello"}), 0.3)
        await until(lambda: agent.lit[version])
        assert (agent.heard[version][0], agent.lit[version][0]) == ("echo hello", "on")
        assert context.read(agent.back[version]).data == "echo hello"

    ros1_network.run(main)


@pytest.mark.parametrize("version", [1, 2])
def test_a_call_to_a_silent_service_fails_and_does_not_block_other_rules(
    running: tuple[Everything, rs.Context], ros1_network: Network, version: int, caplog: pytest.LogCaptureFixture
) -> None:
    agent, context = running
    silent = agent.silent[version]

    async def main() -> None:
        failure = asyncio.ensure_future(context.next(silent.failed))
        agent.ticked.clear()
        asyncio.get_running_loop().call_soon(context.put, silent, True)
        await until(failure.done, lambda: context.emit(agent.tick))
        assert "did not answer within 0.3 s" in await failure
        assert len(agent.ticked) > 3

    with caplog.at_level(logging.CRITICAL, "ravestate"):
        ros1_network.run(main)


@pytest.mark.parametrize("way", WAYS)
def test_an_until_condition_cancels_the_goal_of_an_action(
    running: tuple[Everything, rs.Context], ros2_network: Network, way: str
) -> None:
    agent, context = running

    async def main() -> None:
        for told in (agent.fed, agent.failures, agent.interrupted, agent.ended):
            told.clear()
        context.emit(agent.go[way])
        await until(lambda: agent.fed)
        context.emit(agent.stop)
        await until(lambda: agent.ended)  # the server has reported that it cancelled the goal
        if way == "the writer's until":
            await until(lambda: agent.failures)
            assert agent.failures == ["the goal was cancelled"]
        if way == "perform":
            await until(lambda: agent.interrupted)
        assert agent.interrupted == ([True] if way == "perform" else [])

    ros2_network.run(main)


def test_the_result_of_an_action_raises_the_changed_signal_of_its_slot(
    running: tuple[Everything, rs.Context], ros2_network: Network
) -> None:
    agent, context = running

    async def main() -> None:
        asyncio.get_running_loop().call_soon(context.emit, agent.go["to the end"])
        assert list((await context.next(agent.count.changed)).sequence) == [0, 1, 1, 2, 3]
        await until(lambda: agent.results)
        assert agent.results == [[0, 1, 1, 2, 3]]

    ros2_network.run(main)


@pytest.mark.parametrize(
    ("type_", "words"),
    [("actionlib/Test", "the goal was cancelled"), ("nowhere/Walk", "there is no definition of nowhere/action/Walk")],
)
def test_perform_fails_if_the_slots_own_rule_ends_without_a_result(type_: str, words: str) -> None:
    agent = rs.Module("agent")
    stop, failures = agent.signal("stop", input=True), asyncio.Queue[str]()
    walk = ros2.action(agent, "walk", action="/walk", type=type_, until=stop)

    @agent.rule(when=rs.startup, writes=walk)
    async def go(ctx: rs.RuleContext) -> None:
        try:
            await ros2.perform(ctx, walk, {})
        except rs.PlatformError as error:
            failures.put_nowait(str(error))

    async def main() -> None:
        settings = {"ros2": {"backend": "bus", "bus": f"127.0.0.1:{free_port()}", "definitions": [str(OWN)]}}
        async with rs.Context(agent, settings=settings) as context, asyncio.timeout(PATIENCE):
            await until(lambda: not failures.empty(), lambda: context.emit(stop))
            assert words in await failures.get()

    asyncio.run(main())


def test_in_a_simulation_the_test_writes_the_slots_and_no_node_connects() -> None:
    agent = rs.Module("agent", requires=[ros2])
    chat = ros2.subscriber(agent, "chat", topic="/chat", type="std_msgs/String")
    answer = ros2.publisher(agent, "answer", topic="/answer", type="std_msgs/String")

    @agent.rule(when=chat.changed, writes=answer)
    async def reply(ctx: rs.RuleContext) -> None:
        ctx[answer] = {"data": ctx.payload(chat.changed)["data"].upper()}

    with simulate(agent) as sim:
        sim.put(chat, {"data": "hello"})
        assert sim.read(answer) == {"data": "HELLO"}
        assert sim.read(ros2.node) is None


@pytest.mark.parametrize("qos", ["latched", {"durability": "transient_local"}])
def test_a_publisher_with_a_transient_local_qos_keeps_its_last_message_for_late_subscribers(qos: Any) -> None:
    agent = rs.Module("agent")
    sign = ros2.publisher(agent, "sign", topic="/sign", type="std_msgs/String", qos=qos)

    async def hear(bus: Bus) -> str:
        async with opened(ros2.make_node(ros2.Settings(backend="bus", bus=bus.address))) as late:
            signs: list[str] = []
            late.subscribe(
                "/sign", "std_msgs/String", lambda message: signs.append(message.data),
                qos=quality(qos, depth=1, latch=False),
            )  # fmt: skip
            await until(lambda: signs)
            return signs[0]

    async def main() -> None:
        port = free_port()
        settings = {"ros2": {"backend": "bus", "bus": f"127.0.0.1:{port}"}}
        async with rs.Context(agent, settings=settings) as context:
            await until(lambda: context.read(ros2.node))
            context.put(sign, "open")
            for _ in range(2):  # after a restart of the bus, the node sends the message again
                async with Bus(port) as bus:
                    assert await hear(bus) == "open"

    the_loop().run(asyncio.wait_for(main(), PATIENCE))


def test_a_publisher_of_ros_1_ignores_the_qos_of_ros_2() -> None:
    async def main() -> None:
        async with Bus(0) as bus, opened(ros1.make_node(ros1.Settings(backend="bus", bus=bus.address))) as node:
            chat = node.advertise("/chat", "std_msgs/String", qos=quality("latched", depth=1, latch=False))
            assert not chat.latches

    the_loop().run(main())


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"type": "String"}, "write PACKAGE/NAME"),
        ({"keep": "newest"}, "keep='latest' or keep='all'"),
        ({"rate": 0}, "rate=0 must be a number"),
        ({"qos": "sensor"}, "qos='sensor' is not a profile"),
        ({"qos": {"dept": 3}}, "did you mean 'depth'"),
        ({"qos": {"reliability": "good"}}, "'reliable' or 'best_effort'"),
    ],
)
def test_a_wrong_argument_is_refused_at_the_declaration(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(rs.DeclarationError, match=words):
        ros2.subscriber(rs.Module("agent"), "chat", **{"topic": "/chat", "type": "std_msgs/String", **wrong})


def test_in_virtual_time_a_rule_that_performs_a_goal_gets_an_error() -> None:
    agent = rs.Module("agent")
    walk = ros2.action(agent, "walk", action="/walk", type="test_msgs/Fibonacci")
    reasons: list[str] = []

    @agent.rule(when=rs.startup, writes=walk)
    async def go(ctx: rs.RuleContext) -> None:
        try:
            await ros2.perform(ctx, walk, {"order": 5})
        except PlatformError as error:
            reasons.append(str(error))

    del go
    with simulate(agent) as sim:
        sim.advance(1.0)
        assert reasons == ["agent:walk has no node; in virtual time, there is none"]
        assert sim.fired == ["agent:go"] and not sim.read(rs.activity)
