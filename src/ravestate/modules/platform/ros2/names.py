"""The names of `ros2`: its settings, its module, its slot, and the functions that declare slots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import pydantic

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules.platform.ros import Declarations, Node, NodeSettings, open_node
from ravestate.modules.platform.ros.places import ros2_place


class Settings(NodeSettings):
    """The settings of the node of ROS 2."""

    backend: Literal["auto", "rclpy", "dds", "bus"] = "auto"
    """``rclpy``; ``dds``, which carries only topics; the built-in ``bus``, without actions; or ``auto``: rclpy, or else
    dds."""
    domain: int | None = pydantic.Field(None, ge=0, le=232)
    """The number of the ROS 2 domain. By default ``ROS_DOMAIN_ID`` in the environment, or else 0."""


module = rs.Module("ros2", settings=Settings)


def make_node(settings: Settings, failed: Callable[[PlatformError], None] | None = None) -> Node:
    """Return a node of ROS 2 with these settings. The node connects at its first use."""
    environment = {"ROS_DOMAIN_ID": "" if settings.domain is None else str(settings.domain)}
    return open_node(
        2, settings, lambda: ros2_place(settings.python, settings.backend), environment,
        bus=settings.backend == "bus", failed=failed,
    )  # fmt: skip


node: rs.Slot[Node | None] = module.slot("node", None)
"""The node of this context; None before the node starts, and in virtual time."""

declarations = Declarations(2, module, node)
subscriber = declarations.subscriber
publisher = declarations.publisher
service = declarations.service
action = declarations.action
