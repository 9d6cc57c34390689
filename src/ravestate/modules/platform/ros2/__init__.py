"""ROS 2: slots that are bound to topics, services and actions."""

from __future__ import annotations

from ravestate.modules.platform.ros import perform, play

from . import rules as rules
from .names import Settings, action, make_node, module, node, publisher, service, subscriber

__all__ = ["Settings", "action", "make_node", "module", "node", "perform", "play", "publisher", "service", "subscriber"]
