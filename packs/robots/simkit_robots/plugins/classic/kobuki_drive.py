"""Kobuki base (TurtleBot 2) in Gazebo Classic: `libgazebo_ros_kobuki.so`.

The topics, the frames, the covariances and the timeout are those of `gazebo_ros_kobuki.cpp` in kobuki_gazebo_plugins,
which also has no limits of speed and acceleration.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.extend import boolean, listens, number, publishes, text
from simkit.float_sum import float_sum
from simkit.plugins.classic.diff_drive import CommonDiffDriveOptions, GazeboRosDiffDrive, Pair
from simkit.plugins.drives.odometry import COMMAND_TYPES, DeadReckoning
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, BodyTwist, LatePose
from simkit.plugins.find_entities import find_joint
from simkit.plugins.joint_states import JOINT_STATE
from simkit_robots.plugins.classic.kobuki_sensors import PACKAGES, PREFIX, KobukiSensorOptions, KobukiSensors

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Empty, MotorPower, Twist, TwistStamped

_EMPTY: Final = "std_msgs/msg/Empty"
_MOTOR_POWER: Final = tuple(f"{package}/msg/MotorPower" for package in PACKAGES)
_OFF, _ON = 0, 1  # states of MotorPower


class KobukiOptions(KobukiSensorOptions, CommonDiffDriveOptions):
    """Options of `GazeboRosKobuki`; the frames and the topics below `<base_prefix>` have fixed names.

    Attributes:
        timeout: time for which a command stays active [s].
    """

    odometry_source = "encoder"
    odometry_frame = "odom"
    robot_base_frame = "base_footprint"
    update_rate = 0.0
    publish_wheel_joint_state = True
    is_level = True

    left_joint: str = text(element="left_wheel_joint_name", required=True)
    right_joint: str = text(element="right_wheel_joint_name", required=True)
    wheel_separation: float = number(0.23, "m", minimum=1e-6)
    wheel_diameter: float = number(0.07, "m", minimum=1e-6)
    max_wheel_torque: float = number(1.0, "N·m", element="torque", minimum=0)
    timeout: float = number(0.6, "s", element="velocity_command_timeout", minimum=0)
    publish_odom_tf: bool = boolean(element="publish_tf")
    covariance_x: float = number(0.1, minimum=0)
    covariance_y: float = number(0.1, minimum=0)
    covariance_yaw: float = number(0.05, minimum=0)

    @property
    def command_topic(self) -> str:  # type: ignore[override]
        """Topic of the velocity commands."""
        return self.topic("commands/velocity")

    def _read_pairs(self) -> tuple[Pair, ...]:
        return (Pair(self.left_joint, self.right_joint, self.wheel_separation, self.wheel_diameter / 2),)


class GazeboRosKobuki(KobukiSensors, GazeboRosDiffDrive):
    """Drives two wheels from `mobile_base/commands/velocity`, until the timeout of the command.

    `mobile_base/commands/motor_power` switches the motors off and on. The odometry is on `odom`, with `<publish_tf>`
    also on `/tf`: the distance is from the wheels, and the heading from the IMU `<imu_name>`. Without an IMU, or with
    `<odometry_noise>`, the heading is from the wheels, too. `mobile_base/commands/reset_odometry` sets the pose to
    zero. The states of the wheels are on `joint_states`. The IMU is on `mobile_base/sensors/imu_data`; the changes of
    the bumper, of the cliff sensors and of the wheel drops are on `mobile_base/events/…`, and the present states of all
    sensors on `mobile_base/sensors/core`.

    With `<dock_model>`, the infrared signals of that docking station are on `mobile_base/sensors/dock_ir`.
    `<base_prefix>` replaces `mobile_base`. `<message_package>` is the package of all these messages:
    `kobuki_ros_interfaces` (ROS 2) or `kobuki_msgs` (ROS 1).
    """

    endpoints = (
        listens(f"{PREFIX}/commands/velocity", *COMMAND_TYPES, named_by=("base_prefix",)),
        listens(f"{PREFIX}/commands/motor_power", *_MOTOR_POWER, named_by=("base_prefix",)),
        listens(f"{PREFIX}/commands/reset_odometry", _EMPTY, named_by=("base_prefix",)),
        publishes("odom", ODOMETRY),
        publishes("/tf", TRANSFORMS),
        publishes("ground_truth/odom", ODOMETRY),
        publishes("ground_truth/wheel_slip", "simkit_msgs/msg/WheelMotion"),
        publishes("joint_states", JOINT_STATE),
        *KobukiSensors.sensor_endpoints,
    )
    option_types = (KobukiOptions,)
    filenames = ("libgazebo_ros_kobuki.so",)

    options: KobukiOptions

    def read(self, params: Params) -> CommonDiffDriveOptions:
        return KobukiOptions(params).read_all()

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        super().prepare(scene, params, builder)
        options = self.options
        joints = [find_joint(scene, name, params) for name in (options.left_joint, options.right_joint) if self._joints]
        self.find_sensors(scene, params, [joint.child_link for joint in joints if joint is not None])

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        options = self.options
        self._commanded_ns = self.sim.time_ns
        self._has_power = True
        self._turn_rate = 0.0
        self.listen(options.topic("commands/motor_power"), _MOTOR_POWER, self._on_motor_power)
        self.listen(options.topic("commands/reset_odometry"), _EMPTY, self._on_reset_odometry)
        self.open_sensors(parent, options)

    def command_timeout(self, _: str) -> float:
        """Return the time for which a command stays active [s]."""
        return self.options.timeout

    # ------------------------------------------------------------------ commands

    def before_step(self) -> None:
        if not self._has_power or self.sim.time_ns - self._commanded_ns > self.options.timeout * 1e9:
            self._command = (0.0, 0.0)
        super().before_step()

    def _on_command(self, message: Twist | TwistStamped) -> None:
        self._commanded_ns = self.sim.time_ns
        super()._on_command(message)

    def _on_motor_power(self, message: MotorPower) -> None:
        if message.state in (_OFF, _ON):
            self._has_power = message.state == _ON

    def _on_reset_odometry(self, _message: Empty) -> None:
        self._reckoning = DeadReckoning()
        if self._erring is not None:
            self._erring.reckoning = DeadReckoning()
            self._erring.covariance = np.zeros((3, 3))

    # ------------------------------------------------------------------ odometry

    def read_encoders(self) -> tuple[float, float]:
        return self._first_angles()

    def _advance(self) -> None:
        """Advance the odometry: the distance from the wheels, the turn from the IMU."""
        if self._imu is None:
            super()._advance()
            return
        now = self.sim.time_ns
        elapsed, self._last_read_ns = (now - self._last_read_ns) * 1e-9, now
        reading = self._imu.latest
        self._turn_rate = 0.0 if reading is None else float(reading.angular_velocity.z)
        angles, radius = self._first_angles(), self.options.pairs[0].radius
        ahead = float_sum(new - old for new, old in zip(angles, self._angles, strict=True)) * radius / 2
        self._angles = angles
        self._reckoning.go(ahead, 0.0, self._turn_rate * elapsed)

    def _measured(self) -> tuple[LatePose, BodyTwist]:
        pose, twist = super()._measured()
        if self._imu is not None and self._erring is None:
            twist = BodyTwist(twist.linear, (0.0, 0.0, self._turn_rate))
        return pose, twist
