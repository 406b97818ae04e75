"""Drive of the Kobuki base (TurtleBot 2) in Gazebo Classic: `libgazebo_ros_kobuki.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.classic.diff_drive import CommonDiffDriveOptions, GazeboRosDiffDrive, Pair
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS
from simkit.plugins.endpoints import listens, publishes
from simkit.plugins.joint_states import JOINT_STATE
from simkit.plugins.options import boolean, number, text

if TYPE_CHECKING:
    from simkit.msgs import Twist, TwistStamped
    from simkit.runtime import Model

_COMMAND = "mobile_base/commands/velocity"


class KobukiOptions(CommonDiffDriveOptions):
    """Options of `GazeboRosKobuki`; the topics and frames have fixed names.

    Attributes:
        timeout: time for which a command stays active [s].
    """

    command_topic = _COMMAND
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

    def _read_pairs(self) -> tuple[Pair, ...]:
        return (Pair(self.left_joint, self.right_joint, self.wheel_separation, self.wheel_diameter / 2),)


class GazeboRosKobuki(GazeboRosDiffDrive):
    """Drives two wheels from `mobile_base/commands/velocity`, until the timeout of the command.

    The odometry from the wheels is on `odom`, with `<publish_tf>` also on `/tf`. The states of the wheels are on
    `joint_states`. The events of the bumper and of the cliff sensors are not published.
    """

    endpoints = (
        listens(_COMMAND, *COMMAND_TYPES),
        publishes("odom", ODOMETRY),
        publishes("/tf", TRANSFORMS),
        publishes("ground_truth/odom", ODOMETRY),
        publishes("joint_states", JOINT_STATE),
    )
    option_types = (KobukiOptions,)
    filenames = ("libgazebo_ros_kobuki.so",)

    options: KobukiOptions

    def read(self, params: Params) -> CommonDiffDriveOptions:
        return KobukiOptions(params).read_all()

    def load(self, parent: Model, params: Params) -> None:
        super().load(parent, params)
        self._commanded_ns = self.sim.time_ns

    def before_step(self) -> None:
        if self.sim.time_ns - self._commanded_ns > self.options.timeout * 1e9:
            self._command = (0.0, 0.0)
        super().before_step()

    def _on_command(self, message: Twist | TwistStamped) -> None:
        self._commanded_ns = self.sim.time_ns
        super()._on_command(message)
