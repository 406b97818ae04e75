"""`gz_ros2_control`: the controller manager of ROS 2 in gz."""

from __future__ import annotations

from simkit.control.host import ControlHost


class GzRos2Control(ControlHost):
    """Runs the controllers that the files in `<parameters>` declare; see `docs/ros2_control.md`."""

    filenames = ("libgz_ros2_control-system.so", "libign_ros2_control-system.so")
    names = ("gz_ros2_control::GazeboSimROS2ControlPlugin", "ign_ros2_control::IgnitionROS2ControlPlugin")
