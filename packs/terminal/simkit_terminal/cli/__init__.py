"""Command of the pack for ROS 2."""
