"""Of it the documentation uses one exception."""


class ExternalShutdownException(Exception):
    """ROS was shut down while a node was spinning."""
