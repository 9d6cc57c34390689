"""ROS 1: slots that are topics and services."""

from __future__ import annotations

from ravestate.modules.platform.ros import play

from .names import Settings, make_node, module, node, publisher, service, subscriber

__all__ = ["Settings", "make_node", "module", "node", "play", "publisher", "service", "subscriber"]
