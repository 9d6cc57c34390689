"""The common part of `ros1`, `ros2` and `roboyio`: nodes, and slots that are bound to topics, services and actions."""

from __future__ import annotations

from .bag import play
from .bus import Bus, host_and_port
from .naming import quality
from .node import Channel, Node
from .rules import NodeSettings, connect, open_node
from .slots import ActionSlot, Binding, Declarations, ServiceSlot, TopicSlot, perform
from .types import Types, plain

__all__ = [
    "ActionSlot",
    "Binding",
    "Bus",
    "Channel",
    "Declarations",
    "Node",
    "NodeSettings",
    "ServiceSlot",
    "TopicSlot",
    "Types",
    "connect",
    "host_and_port",
    "open_node",
    "perform",
    "plain",
    "play",
    "quality",
]
