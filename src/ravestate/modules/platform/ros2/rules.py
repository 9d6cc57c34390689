"""The rule that connects a context to ROS 2."""

from __future__ import annotations

from ravestate.modules.platform.ros import connect

from .names import make_node, module, node

connect(module, 2, node, make_node)
