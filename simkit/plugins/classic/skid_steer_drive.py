"""Skid steering of Gazebo Classic on ROS 1, four wheels: `libgazebo_ros_skid_steer_drive.so`."""

from __future__ import annotations

from simkit.params import Params
from simkit.plugins.classic.diff_drive import GazeboRosDiffDrive, Options, Pair
from simkit.plugins.drives.odometry_noise import read_odometry_noise


class GazeboRosSkidSteerDrive(GazeboRosDiffDrive):
    """Drives two pairs of wheels from `<commandTopic>` (`cmd_vel`), both sides as a differential drive does.

    The odometry on `<odometryTopic>` (`odom`) is the model's true pose and twist in the plane: height zero, attitude
    whole. With `<broadcastTF>` the pose goes out on `/tf` too, height and all. The last command holds until the next.
    """

    filenames = ("libgazebo_ros_skid_steer_drive.so",)
    is_level = True

    def read(self, params: Params) -> Options:
        separation = params.number("wheelSeparation", 0.4, minimum=1e-6)
        radius = params.number("wheelDiameter", 0.15, minimum=1e-6) / 2
        left, right = (
            [params.text(f"{side}{end}Joint", f"{side}_{end.lower()}_joint") for end in ("Front", "Rear")]
            for side in ("left", "right")
        )
        return Options(
            update_rate=params.number("updateRate", 100.0, minimum=0),
            pairs=tuple(Pair(a, b, separation, radius) for a, b in zip(left, right, strict=True)),
            max_torque=params.number("torque", 5.0, minimum=0),
            max_acceleration=0.0,
            command_topic=params.text("commandTopic", "cmd_vel"),
            odometry_topic=params.text("odometryTopic", "odom"),
            odometry_frame=params.text("odometryFrame", "odom"),
            base_frame=params.text("robotBaseFrame", "base_footprint"),
            from_encoders=False,
            publish_odom=True,
            publish_odom_tf=params.boolean("broadcastTF", False),
            publish_wheel_tf=False,
            publish_wheel_joint_state=False,
            publish_ground_truth=params.boolean("publish_ground_truth", False),
            covariance=(
                params.number("covariance_x", 1e-4, minimum=0),
                params.number("covariance_y", 1e-4, minimum=0),
                params.number("covariance_yaw", 1e-2, minimum=0),
            ),
            noise=read_odometry_noise(params),
        )
