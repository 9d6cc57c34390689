"""Messages of ROS."""
