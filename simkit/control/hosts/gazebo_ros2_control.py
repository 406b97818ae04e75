"""`libgazebo_ros2_control.so`: the controller manager of ROS 2 in Gazebo Classic."""

from __future__ import annotations

from simkit.control.host import ControlHost


class GazeboRos2Control(ControlHost):
    """Runs the controllers that the files in `<parameters>` declare; see `docs/ros2_control.md`."""

    filenames = ("libgazebo_ros2_control.so",)
