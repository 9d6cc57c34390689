"""Fixtures: the networks of ROS 1 and ROS 2."""

from modules.platform.ros.conftest import ros1_network, ros2_network

__all__ = ["ros1_network", "ros2_network"]
