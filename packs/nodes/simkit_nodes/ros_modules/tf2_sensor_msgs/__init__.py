"""Point clouds in other frames, as the ROS 2 package `tf2_sensor_msgs`."""

from __future__ import annotations

from simkit_nodes.ros_modules.tf2_sensor_msgs.tf2_sensor_msgs import do_transform_cloud, transform_points

__all__ = ["do_transform_cloud", "transform_points"]
