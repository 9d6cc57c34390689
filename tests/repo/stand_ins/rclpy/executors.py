"""The one exception that the documentation uses."""


class ExternalShutdownException(Exception):
    """ROS was shut down while a node was spinning."""
