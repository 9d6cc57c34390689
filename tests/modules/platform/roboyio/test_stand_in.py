"""The stand-in robot turns its axes, without a network."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, cast

import pytest

from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules import roboyio
from ravestate.modules.platform.roboyio.stand_in import StandIn
from ravestate.modules.platform.ros import Node, Types


class Topics:
    """A stand-in for a node. It keeps the function that handles the messages of each topic."""

    def __init__(self) -> None:
        self.types = Types(2)
        self.handlers: dict[str, Callable[[Any], None]] = {}

    def subscribe(self, topic: str, kind: str, handle: Callable[[Any], None], **_: Any) -> None:
        self.handlers[topic] = handle

    def advertise(self, *_: Any, **__: Any) -> None: ...


@in_virtual_time
async def test_an_axis_turns_again_after_its_command_was_cancelled() -> None:
    topics = Topics()
    robot = StandIn(roboyio.load_robot("turtlebot"), cast(Node, topics))

    def turn(speed: float) -> None:
        topics.handlers["/cmd_vel"](SimpleNamespace(angular=SimpleNamespace(z=speed)))

    turn(1.0)
    await past(1.0)
    assert robot.looks.yaw == pytest.approx(1.0, abs=0.06)
    await robot.close()
    await past(1.0)
    assert robot.looks.yaw == pytest.approx(1.0, abs=0.06)
    turn(-0.5)
    await past(1.0)
    turn(0.0)
    await past(1.0)
    assert robot.looks.yaw == pytest.approx(0.5, abs=0.06)
