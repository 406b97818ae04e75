"""Controllers of Fetch's `robot_controllers`, which start with their first goal and then replace each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from simkit import Params
from simkit.plugins.drives.odometry import COMMAND_TYPES
from simkit.plugins.drives.odometry_messages import ODOMETRY, TRANSFORMS, transforms
from simkit.plugins.ros_parameter_block import read_numbers
from simkit_control.controllers.diff_drive import DiffDriveController
from simkit_control.controllers.gripper_action import GripperActionController
from simkit_control.controllers.joint_state_broadcaster import JointStateBroadcaster
from simkit_control.controllers.joint_trajectory_kinds import PositionJointTrajectoryController
from simkit_control.controllers.point_head import PointHeadAction
from simkit_control.plugins.ros2_control.diff_drive_options import RateLimits
from simkit_control.plugins.ros2_control.robot_controller import RobotController

if TYPE_CHECKING:
    from simkit.extend import GoalHandle
    from simkit.msgs import Twist, TwistStamped
    from simkit_control.plugins.ros2_control.diff_drive_options import DriveOptions


class FollowJointTrajectory(RobotController, PositionJointTrajectoryController):
    """Follows trajectories like the ROS 1 controller; its action has the name of the controller itself."""

    types = ("robot_controllers/FollowJointTrajectoryController",)
    topics: ClassVar[tuple[str, ...]] = ()

    def configure(self) -> None:
        self.autostart = self.params.boolean("autostart", False)
        for name in ("stop_with_action", "stop_on_path_violation"):
            self.params.child(name)
        super().configure()


class PointHead(RobotController, PointHeadAction):
    """Turns the head to a point, through the trajectory controller of the same head."""

    types: ClassVar[tuple[str, ...]] = ("robot_controllers/PointHeadController",)
    autostart = True  # it claims no joints, so that it can always be active

    def configure(self) -> None:
        params = self.params
        pan, tilt = params.text("pan_joint", "head_pan_joint"), params.text("tilt_joint", "head_tilt_joint")
        self.rename({"controller": self.name.rpartition("/")[0], "joints": [pan, tilt]})
        super().configure()


class GravityCompensation(RobotController):
    """Accepts the parameters of gravity compensation: joints without a controller are held, so it does nothing."""

    types = ("robot_controllers/GravityCompensation",)
    autostart = True

    def configure(self) -> None:
        for name in ("root", "tip", "autostart"):
            self.params.child(name)

    def update(self, now_ns: int, period: float) -> None:
        """Do nothing."""


class ScaledMimic(RobotController):
    """Keeps `controlled_joint` at `mimic_scale` times the position of `mimic_joint`, such as Fetch's bellows."""

    types = ("robot_controllers/ScaledMimicController",)

    def configure(self) -> None:
        params = self.params
        self.autostart = params.boolean("autostart", False)
        self._leader = params.text("mimic_joint", required=True) or ""
        self._follower = params.text("controlled_joint", required=True) or ""
        self._scale = params.number("mimic_scale", 1.0)

    def command_interfaces(self) -> Sequence[str]:
        return (f"{self._follower}/position",)

    def state_interfaces(self) -> Sequence[str]:
        return (f"{self._leader}/position",)

    def update(self, now_ns: int, period: float) -> None:
        self.commands.values = self._scale * self.states.values


class RobotJointStates(JointStateBroadcaster):
    """Publishes `joint_states` at 100 Hz, as the plugins of Fetch and PR2 do themselves."""

    types = ("fetch_gazebo/JointStates", "pr2_controller_manager/JointStates")

    def configure(self) -> None:
        self.update_rate = 100
        super().configure()


class ParallelGripper(RobotController, GripperActionController):
    """Moves two fingers to half of a goal's opening each; their force is at most the goal's `max_effort`.

    A goal is reached within 2 mm. A gripper whose opening changes less than 5 mm in 2 s is stalled, usually on an
    object; the goal then succeeds, too. The fingers keep pressing.
    """

    types = ("robot_controllers/ParallelGripperController",)
    _STIFFNESS = 1000.0  # [N/m]
    _DAMPING = 20.0  # [N·s/m]
    _SMALLEST_MOTION = 0.005  # [m]

    def configure(self) -> None:
        params = self.params
        left = params.text("l_gripper_joint", "l_gripper_finger_joint")
        right = params.text("r_gripper_joint", "r_gripper_finger_joint")
        self._fingers = left, right
        self._widest = params.number("max_position", 0.1, minimum=0.0)
        self._strongest = params.number("max_effort", 10.0, minimum=0.0)
        params.child("use_centering_pid")
        params.block("centering").mark_all_read()  # both fingers have their own position loop, so they stay centred
        self._last_opening = -1.0
        names = {"joint": left, "goal_tolerance": 0.002, "stall_timeout": 2.0, "allow_stalling": True}
        self.rename({**names, "action_monitor_rate": 50.0, "max_effort": self._strongest})
        super().configure()

    def command_interfaces(self) -> Sequence[str]:
        return tuple(f"{name}/effort" for name in self._fingers)

    def state_interfaces(self) -> Sequence[str]:
        return tuple(f"{name}/{kind}" for kind in ("position", "velocity") for name in self._fingers)

    @property
    def _opening(self) -> float:
        return float(self.states.values[:2].sum())

    def activate(self) -> None:
        super().activate()
        self._target, self._last_opening = self._opening, -1.0

    def deactivate(self) -> None:
        super().deactivate()
        self.commands.values = np.zeros(2)

    def _on_goal(self, goal: GoalHandle) -> None:
        position, effort, fault = self._read_command(goal.request)
        if fault:
            goal.reject(fault)
            return
        if self._goal is not None:
            self._goal.canceled(reason="Current goal cancelled due to new incoming action.")
        self._goal, self._target = goal, min(max(position, 0.0), self._widest)
        self._effort = effort if 0.0 < effort <= self._strongest else self._strongest
        self._moved_ns, self._next_feedback, self._last_opening = self.sim.time_ns, 0, -1.0

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is self._goal:
            self._goal, self._target = None, self._opening
            goal.canceled()

    def update(self, now_ns: int, period: float) -> None:
        position, velocity = self.states.values[:2], self.states.values[2:]
        efforts = self._STIFFNESS * (self._target / 2.0 - position) - self._DAMPING * velocity
        self.commands.values = np.clip(efforts, -self._effort, self._effort)
        self._commanded_effort = float(np.abs(self.commands.values).sum())
        if self._goal is not None:
            opening = self._opening
            if abs(opening - self._last_opening) > self._SMALLEST_MOTION:
                self._last_opening, self._moved_ns = opening, now_ns
            # a velocity of 0 leaves the time of the last motion unchanged
            self._report_progress(self._goal, now_ns, self._target - opening, 0.0)

    def _feedback(self) -> dict[str, object]:
        return {"position": self._opening, "effort": self._commanded_effort}


class PiecewiseLimits(RateLimits):
    """Bounds on a speed and on its acceleration, which may depend on the speed.

    Args:
        params: parameters of the controller.
        axis: axis in the names of the parameters, x or r.
        fastest: default of the largest speed [m/s or rad/s].
    """

    def __init__(self, params: Params, axis: str, fastest: float) -> None:
        self.most = params.number(f"max_velocity_{axis}", fastest, minimum=0.0)
        self.least = -self.most
        name = f"max_acceleration_{axis}"
        element = params.child(name)
        if element is not None and element.children:
            block = params.block(name)
            self._interval = block.number("interval", 1.0, minimum=1e-6)
            counts = {key: max(len(block.all(key)), 1) for key in ("accel", "decel")}
            tables = (read_numbers(block, key, [1.0] * count, minimum=1e-6) for key, count in counts.items())
            self._up, self._down = ([float(value) for value in table] for table in tables)
        else:
            self._interval = 1.0
            self._up = self._down = [params.number(name, 1.0, minimum=1e-6)]

    def limit(self, target: float, last: float, before_last: float, period: float) -> float:
        """Return a target speed after limiting it and its acceleration."""
        speed = min(max(target, self.least), self.most)
        speeds_up = last >= 0.0 if speed > last else speed < 0.0
        table = self._up if speeds_up else self._down
        change = float(table[min(int(abs(last) / self._interval), len(table) - 1)]) * period
        return min(max(speed, last - change), last + change)


class DiffDriveBase(RobotController, DiffDriveController):
    """Drives Fetch's base from `~/command` and `cmd_vel`, with odometry on `odom` and `/tf`."""

    types = ("robot_controllers/DiffDriveBaseController",)

    def configure(self) -> None:
        params = self.params
        limits = PiecewiseLimits(params, "x", 1.0), PiecewiseLimits(params, "r", 4.5)
        for name in ("wheel_rotating_threshold", "rotating_threshold", "moving_threshold"):
            params.child(name)  # against noise of real encoders
        self.rename(
            {
                "left_wheel": params.text("l_wheel_joint", "l_wheel_joint"),
                "right_wheel": params.text("r_wheel_joint", "r_wheel_joint"),
                "wheel_separation": params.number("track_width", 0.37476, minimum=1e-6),
                "wheel_radius": 1.0 / params.number("radians_per_meter", 16.5289, minimum=1e-6),
                "enable_odom_tf": params.boolean("publish_tf", True),
                "odom_frame_id": params.text("odometry_frame", "odom"),
                "base_frame_id": params.text("base_frame", "base_link"),
                "cmd_vel_timeout": params.number("timeout", 0.25, minimum=0.0),
                "publish_rate": params.number("publish_frequency", 100.0, minimum=0.0),
            }
        )
        super().configure()
        self._options.linear, self._options.angular = limits

    def _open_topics(self, options: DriveOptions) -> None:
        for topic in ("~/command", "cmd_vel"):
            self.listen(topic, COMMAND_TYPES, self._on_command)
        self._odom = self.advertise("odom", ODOMETRY)
        self._tf = self.advertise("/tf", TRANSFORMS) if options.publish_tf else None
        if self._tf is not None:
            self._tf.present = lambda: transforms(self.sim.time_ns, self.odometry_frame)
        self._limited = None

    def _on_command(self, message: Twist | TwistStamped) -> None:
        if not self._accepts_commands:
            self.manager.request_start(self.name)
        super()._on_command(message)
