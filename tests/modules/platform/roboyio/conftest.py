"""The fixtures of the networks."""

from modules.platform.ros.conftest import ros1_network, ros2_network

__all__ = ["ros1_network", "ros2_network"]
