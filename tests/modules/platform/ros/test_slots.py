"""Slots that are topics, services and actions, in whole agents on real networks."""

import asyncio
import logging
from typing import Any

import pytest

import ravestate as rs
from modules.platform.ros.networks import PATIENCE, Network, pause, until
from ravestate.modules import ros1, ros2
from ravestate.testing import simulate


def test_text_in_on_a_topic_answers_on_another(either: Network) -> None:
    ros = either.module
    agent = rs.Module("agent", requires=[ros])
    back = ros.subscriber(agent, "back", topic="/back", type="std_msgs/String", keep="all")
    chat = ros.publisher(agent, "chat", topic="/chat", type="std_msgs/String")
    lamp = ros.service(agent, "lamp", service="/lamp", type="std_srvs/SetBool", timeout=10)
    lit = agent.slot("lit", "")
    heard: list[str] = []

    @agent.rule(when=back.changed, writes=lamp)
    async def switch(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(back.changed).data)
        ctx[lamp] = {"data": True}

    @agent.rule(when=lamp.changed, writes=lit)
    async def note(ctx: rs.RuleContext) -> None:
        ctx[lit] = ctx.payload(lamp.changed).message

    async def main() -> None:
        async with rs.Context(agent, settings=either.settings) as context, asyncio.timeout(PATIENCE):
            await until(lambda: heard, lambda: context.put(chat, {"data": "hello"}))
            await until(lambda: context.read(lit) == "on")
            assert heard[0] == "echo hello"
            assert context.read(back).data.startswith("echo ")

    asyncio.run(main())


def test_one_agent_is_on_ros_1_and_ros_2_at_once(ros1_network: Network, ros2_network: Network) -> None:
    agent = rs.Module("agent")
    from1 = ros1.subscriber(agent, "from1", topic="/back", type="std_msgs/String", keep="all")
    to1 = ros1.publisher(agent, "to1", topic="/chat", type="std_msgs/String")
    from2 = ros2.subscriber(agent, "from2", topic="/back", type="std_msgs/String", keep="all")
    to2 = ros2.publisher(agent, "to2", topic="/chat", type="std_msgs/String")

    @agent.rule(when=from1.changed, writes=to2)
    async def forward(ctx: rs.RuleContext) -> None:
        ctx[to2] = {"data": f"1 says {ctx.payload(from1.changed).data}"}

    async def main() -> None:
        settings = ros1_network.settings | ros2_network.settings
        async with rs.Context(agent, settings=settings) as context, asyncio.timeout(PATIENCE):
            await until(lambda: context.read(from2), lambda: context.put(to1, {"data": "hi"}))
            assert context.read(from2).data == "echo 1 says echo hi"

    asyncio.run(main())


def test_a_silent_service_fails_and_holds_nothing_up(either: Network, caplog: pytest.LogCaptureFixture) -> None:
    ros = either.module
    agent = rs.Module("agent", requires=[ros])
    silent = ros.service(agent, "silent", service="/silent", type="std_srvs/SetBool", timeout=0.3)
    ticks = agent.signal("tick")
    ticked: list[float] = []

    @agent.rule(when=ticks)
    async def tick(ctx: rs.RuleContext) -> None:
        ticked.append(ctx.now)

    async def main() -> None:
        async with rs.Context(agent, settings=either.settings) as context, asyncio.timeout(PATIENCE):
            failure = asyncio.ensure_future(context.next(silent.failed))
            await asyncio.sleep(0)
            context.put(silent, True)
            await until(failure.done, lambda: context.emit(ticks), 0.02)
            assert "did not answer within 0.3 s" in await failure
            assert len(ticked) > 3

    with caplog.at_level(logging.CRITICAL, "ravestate"):
        asyncio.run(main())


@pytest.mark.parametrize("way", ["the writer's until", "the slot's until", "perform"])
def test_until_cancels_the_goal_of_an_action(ros2_network: Network, way: str) -> None:
    agent = rs.Module("agent", requires=[ros2])
    go, stop = agent.signal("go", input=True), agent.signal("stop", input=True)
    count = ros2.action(
        agent, "count", action="/count", type="test_msgs/Fibonacci", timeout=15,
        until=stop if way == "the slot's until" else None,
    )  # fmt: skip
    fed: list[Any] = []
    failures: list[str] = []
    cut: list[bool] = []

    @agent.rule(when=go, writes=count, until=None if way == "the slot's until" else stop)
    async def start(ctx: rs.RuleContext) -> None:
        if way != "perform":
            ctx[count] = {"order": 1000}
            return
        try:
            await ros2.perform(ctx, count, {"order": 1000})
        except asyncio.CancelledError:
            cut.append(True)
            raise

    @agent.rule(when=count.feedback)
    async def follow(ctx: rs.RuleContext) -> None:
        fed.append(ctx.payload(count.feedback))

    @agent.rule(when=count.failed)
    async def fail(ctx: rs.RuleContext) -> None:
        failures.append(ctx.payload(count.failed))

    async def main() -> None:
        async with rs.Context(agent, settings=ros2_network.settings) as context, asyncio.timeout(PATIENCE):
            context.emit(go)
            await until(lambda: fed)
            context.emit(stop)
            if way == "the writer's until":
                await until(lambda: failures)
                assert failures == ["the goal was cancelled"]
            await until(lambda: not context.snapshot()["running"] if "running" in context.snapshot() else True)
            seen = len(fed)
            await pause(0.3)
            assert len(fed) <= seen + 1
            assert cut == ([True] if way == "perform" else [])

    asyncio.run(main())


def test_the_result_of_an_action_is_a_change(ros2_network: Network) -> None:
    agent = rs.Module("agent", requires=[ros2])
    count = ros2.action(agent, "count", action="/count", type="test_msgs/Fibonacci", timeout=15)
    results: list[list[int]] = []

    @agent.rule(when=rs.startup, writes=count)
    async def start(ctx: rs.RuleContext) -> None:
        result = await ros2.perform(ctx, count, {"order": 5})
        results.append(list(result.sequence))

    async def main() -> None:
        async with rs.Context(agent, settings=ros2_network.settings) as context:
            result = await context.next(count.changed, timeout=PATIENCE)
            assert list(result.sequence) == [0, 1, 1, 2, 3]
            await until(lambda: results)
            assert results == [[0, 1, 1, 2, 3]]

    asyncio.run(main())


def test_in_virtual_time_slots_are_written_by_the_test_and_nothing_connects() -> None:
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


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"type": "String"}, "write PACKAGE/NAME"),
        ({"keep": "newest"}, "keep='latest' or keep='all'"),
        ({"rate": 0}, "rate=0 must be a number"),
        ({"qos": "sensor"}, "qos='sensor' is no profile"),
        ({"qos": {"dept": 3}}, "did you mean 'depth'"),
        ({"qos": {"reliability": "good"}}, "'reliable' or 'best_effort'"),
    ],
)
def test_a_wrong_argument_is_refused_where_it_is_declared(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(rs.DeclarationError, match=words):
        ros2.subscriber(rs.Module("agent"), "chat", **{"topic": "/chat", "type": "std_msgs/String", **wrong})
