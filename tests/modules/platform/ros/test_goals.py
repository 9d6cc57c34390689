"""Actions of ROS 1, with a real action server of actionlib."""

import asyncio
from typing import Any

import pytest

from modules.platform.ros.networks import Network, until
from ravestate.errors import PlatformError


def test_an_action_gives_feedback_and_a_result_and_can_be_cancelled(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            action = node.action("/steps", "actionlib/Test", timeout=10.0)
            feedback: list[Any] = []
            result = await action.call({"goal": 3}, feedback.append)
            assert result.result == 3
            assert [message.feedback for message in feedback] == [0, 1, 2]
            with pytest.raises(PlatformError, match="/steps: the goal was aborted"):
                await action.call(-1)
            with pytest.raises(PlatformError, match="no field 'gaol'; did you mean 'goal'"):
                await action.call({"gaol": 1})
            cancelled: list[str] = []
            feedback.clear()
            goal = asyncio.ensure_future(action.call(1000, feedback.append))
            await until(lambda: feedback)
            goal.cancel()
            with pytest.raises(asyncio.CancelledError):
                await goal
            node.subscribe(
                "/cancelled", "std_msgs/String", lambda message: cancelled.append(message.data),
                qos={"depth": 1, "reliability": "reliable", "durability": "transient_local"},
            )  # fmt: skip
            await until(lambda: cancelled)
            rows = {row["name"]: row for row in (await node.graph())["actions"]}
            assert rows["/steps"] == {"name": "/steps", "types": ["actionlib/Test"], "servers": 1}

    ros1_network.run(main)


def test_an_action_without_a_server_fails(ros1_network: Network) -> None:
    async def main() -> None:
        async with ros1_network.lent() as node:
            with pytest.raises(PlatformError, match="nobody offers the action /nobody"):
                await node.action("/nobody", "actionlib/Test", timeout=0.3).call(1)

    ros1_network.run(main)


def test_a_goal_fails_if_the_action_server_restarts_and_no_longer_knows_the_goal(ros1_network: Network) -> None:
    """The test acts as the action server. After a restart, a server lists no goals."""

    async def main() -> None:
        async with ros1_network.lent() as node:
            goals: list[str] = []
            options: Any = {"qos": {"depth": 10, "reliability": "reliable", "durability": "volatile"}}
            status = node.advertise("/moody/status", "actionlib_msgs/GoalStatusArray", **options)
            action = node.action("/moody", "actionlib/Test", timeout=10.0)
            node.subscribe(
                "/moody/goal", "actionlib/TestActionGoal", lambda message: goals.append(message.goal_id.id), **options
            )
            goal = asyncio.ensure_future(action.call(1))
            await until(lambda: goals)
            await until(
                goal.done,
                lambda: [
                    status.publish({"status_list": [{"goal_id": {"id": goals[0]}, "status": 1}]}),
                    status.publish({"status_list": []}),
                ],  # type: ignore[arg-type,return-value]
            )
            with pytest.raises(PlatformError, match="the goal was lost: its server restarted"):
                await goal

    ros1_network.run(main)
