"""Actions of ROS 1. In the protocol of actionlib, an action consists of five topics.

So the agent uses an action through channels of topics, and does not need the package actionlib.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from ravestate.errors import PlatformError

from .naming import quality

if TYPE_CHECKING:
    from .node import Node

AGAIN = 0.2
"""If the server has shown no sign of a goal after this many seconds, send the goal again. Servers ignore repeated goals."""
SUCCEEDED = 3
ENDS = {2: "cancelled", 8: "cancelled", 4: "aborted", 5: "refused", 9: "lost"}
"""State in actionlib_msgs/GoalStatus → its name in errors, for the final states of a goal that did not succeed."""


@dataclass(eq=False, slots=True)
class _Goal:
    result: asyncio.Future[Any]
    feedback: Callable[[Any], None] | None
    listed: asyncio.Event = field(default_factory=asyncio.Event)
    tracked: bool = False
    """Whether a status message of the server has listed the goal. Feedback does not set this value, because after the
    feedback, an older status message may arrive. The server sent this message before it got the goal, so the message does
    not list the goal. If the feedback had set the value, the goal would then seem lost."""


class GoalTopics:
    """An action of ROS 1: ``goal`` and ``cancel`` go to the server; ``status``, ``feedback`` and ``result`` come from it.

    Args:
        node: The node.
        name: The name of the action.
        type: The full name of the action's type. The node has already loaded the type.
        timeout: A server must react to a goal (with a status, feedback or a result) within this many seconds.
    """

    def __init__(self, node: Node, name: str, type: str, timeout: float) -> None:
        package, _, short = type.split("/")
        self.name = node.absolute(name)
        self.type = type
        self._node = node
        self._timeout = timeout
        self._goals: dict[str, _Goal] = {}
        self._message = f"{package}/msg/{short}Goal"
        qos = quality(None, depth=10, latch=False)
        every: dict[str, Any] = {"latest": False, "qos": qos}
        self._goal = node.advertise(f"{self.name}/goal", f"{package}/{short}ActionGoal", qos=qos)
        self._cancel = node.advertise(f"{self.name}/cancel", "actionlib_msgs/GoalID", qos=qos)
        self._channels = [
            self._goal,
            self._cancel,
            node.subscribe(f"{self.name}/status", "actionlib_msgs/GoalStatusArray", self._status, **every),
            node.subscribe(f"{self.name}/feedback", f"{package}/{short}ActionFeedback", self._feedback, **every),
            node.subscribe(f"{self.name}/result", f"{package}/{short}ActionResult", self._result, **every),
        ]

    async def call(self, value: Any, feedback: Callable[[Any], None] | None = None) -> Any:
        """Send a goal; return the result. If the task that waits is cancelled, the goal is cancelled too.

        Raises:
            PlatformError: The value does not fit the type, there is no server, or the goal ends without a result.
        """
        message = self._node.types.message(value, self._message)
        if self._goal.fault:
            raise PlatformError(self._goal.fault)
        number = uuid4().hex
        goal = self._goals[number] = _Goal(asyncio.get_running_loop().create_future(), feedback)
        try:
            await self._offer(number, goal, message)
            return await goal.result
        except asyncio.CancelledError:
            self._cancel.publish({"id": number})
            raise
        finally:
            del self._goals[number]

    async def _offer(self, number: str, goal: _Goal, message: Any) -> None:
        """Send a goal again and again until the server reacts to it, because the topics may not be connected yet."""
        try:
            async with asyncio.timeout(self._timeout):
                while not goal.listed.is_set():
                    self._goal.publish({"goal_id": {"id": number}, "goal": message})
                    with contextlib.suppress(TimeoutError):
                        async with asyncio.timeout(AGAIN):
                            await goal.listed.wait()
        except TimeoutError:
            raise PlatformError(f"{self._node.title}: nobody offers the action {self.name}") from None

    def close(self) -> None:
        """Close the channels of the topics."""
        for channel in self._channels:
            channel.close()

    # ------------------------------------------------------------------------------- from the server

    def _status(self, message: Any) -> None:
        listed = {status.goal_id.id for status in message.status_list}
        for number, goal in self._goals.items():
            if number in listed:
                goal.tracked = True
                goal.listed.set()
            elif goal.tracked and not goal.result.done():
                goal.result.set_exception(self._failure("lost: its server restarted"))

    def _feedback(self, message: Any) -> None:
        goal = self._goals.get(message.status.goal_id.id)
        if goal is not None:
            goal.listed.set()
            if goal.feedback is not None and not goal.result.done():
                goal.feedback(message.feedback)

    def _result(self, message: Any) -> None:
        goal = self._goals.get(message.status.goal_id.id)
        if goal is None or goal.result.done():
            return
        goal.listed.set()
        if message.status.status == SUCCEEDED:
            goal.result.set_result(message.result)
        else:
            how = ENDS.get(message.status.status, f"state {message.status.status}")
            goal.result.set_exception(self._failure(f"{how}: {message.status.text}".rstrip(": ")))

    def _failure(self, how: str) -> PlatformError:
        return PlatformError(f"{self._node.title}: {self.name}: the goal was {how}")
