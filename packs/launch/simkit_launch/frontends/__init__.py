"""Readers of launch files that are not Python: XML and YAML of ROS 2, and XML of ROS 1."""
