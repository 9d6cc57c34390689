"""The names of `ros1`: its settings, its module, its slot, and the functions that declare slots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules.platform.ros import Declarations, Node, NodeSettings, open_node
from ravestate.modules.platform.ros.places import ros1_place


class Settings(NodeSettings):
    """The settings of the node of ROS 1."""

    backend: Literal["rospy", "bus"] = "rospy"
    """``rospy``, or the built-in ``bus``."""
    master: str = ""
    """The address of the ROS master. By default ``ROS_MASTER_URI`` in the environment, or else this machine."""
    ip: str = ""
    """This machine's address for other nodes. By default ``ROS_IP`` in the environment."""


module = rs.Module("ros1", settings=Settings)


def make_node(settings: Settings, failed: Callable[[PlatformError], None] | None = None) -> Node:
    """Return a node of ROS 1 with these settings. The node connects at its first use."""
    environment = {"ROS_MASTER_URI": settings.master, "ROS_IP": settings.ip}
    return open_node(
        1, settings, lambda: ros1_place(settings.python), environment, bus=settings.backend == "bus", failed=failed
    )


node: rs.Slot[Node | None] = module.slot("node", None)
"""The node of this context; None before the node starts, and in virtual time."""

declarations = Declarations(1, module, node)
subscriber = declarations.subscriber
publisher = declarations.publisher
service = declarations.service
action = declarations.action
