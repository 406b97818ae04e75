"""Skid steering of Gazebo Classic on ROS 1, four wheels: `libgazebo_ros_skid_steer_drive.so`."""

from __future__ import annotations

from simkit.params import Params
from simkit.plugins.classic.diff_drive import CommonDiffDriveOptions, GazeboRosDiffDrive, Pair
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.options import boolean, number, text


class SkidSteerOptions(CommonDiffDriveOptions):
    """Options of `GazeboRosSkidSteerDrive`."""

    wheel_separation: float = number(0.4, "m", element="wheelSeparation", minimum=1e-6)
    wheel_diameter: float = number(0.15, "m", element="wheelDiameter", minimum=1e-6)
    left_front_joint: str = text("left_front_joint", element="leftFrontJoint")
    left_rear_joint: str = text("left_rear_joint", element="leftRearJoint")
    right_front_joint: str = text("right_front_joint", element="rightFrontJoint")
    right_rear_joint: str = text("right_rear_joint", element="rightRearJoint")
    update_rate: float = number(100.0, "Hz", element="updateRate", minimum=0)
    max_wheel_torque: float = number(5.0, "N·m", element="torque", minimum=0)
    command_topic: str = text("cmd_vel", element="commandTopic")
    odometry_topic: str = text("odom", element="odometryTopic")
    odometry_frame: str = text("odom", element="odometryFrame")
    robot_base_frame: str = text("base_footprint", element="robotBaseFrame")
    publish_odom_tf: bool = boolean(element="broadcastTF")
    covariance_x: float = number(1e-4, minimum=0)
    covariance_y: float = number(1e-4, minimum=0)
    covariance_yaw: float = number(1e-2, minimum=0)

    def _read_pairs(self) -> tuple[Pair, ...]:
        left, right = (self.left_front_joint, self.left_rear_joint), (self.right_front_joint, self.right_rear_joint)
        separation, radius = self.wheel_separation, self.wheel_diameter / 2
        return tuple(Pair(a, b, separation, radius) for a, b in zip(left, right, strict=True))


class GazeboRosSkidSteerDrive(GazeboRosDiffDrive):
    """Drives two pairs of wheels from `<commandTopic>` (`cmd_vel`), both sides as a differential drive does.

    The odometry on `<odometryTopic>` (`odom`) is the model's true pose and twist in the plane: height zero, attitude
    whole. With `<broadcastTF>` the pose goes out on `/tf` too, height and all. The last command holds until the next.
    """

    endpoints = (
        listens("cmd_vel", *COMMAND_TYPES, named_by=("commandTopic",)),
        publishes("odom", "nav_msgs/msg/Odometry", named_by=("odometryTopic",)),
        publishes("/tf", "tf2_msgs/msg/TFMessage"),
        publishes("ground_truth/odom", "nav_msgs/msg/Odometry"),
    )
    option_types = (SkidSteerOptions,)
    filenames = ("libgazebo_ros_skid_steer_drive.so",)
    is_level = True

    def read(self, params: Params) -> CommonDiffDriveOptions:
        return SkidSteerOptions(params).read_all()
