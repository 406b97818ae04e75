"""Options of `simkit run` for ROS 2."""
