"""Plugin that follows paths, as Nav2's `nav2_controller`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from simkit import Params, msgs
from simkit.extend import NEVER, Options, OptionsOf, block, boolean, listens, number, text, texts
from simkit.plugins.drives.odometry_messages import ODOMETRY
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.navigation.footprint import Footprint, read_footprint
from simkit_navigation.plugins.navigation.nodes import ControllerNode
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, look_up, poses_of_path
from simkit_navigation.plugins.navigation.pure_pursuit import PurePursuit, PurePursuitOptions, Speeds
from simkit_navigation.plugins.navigation.tutorial_pure_pursuit import (
    PurePursuitController,
    PurePursuitControllerOptions,
)
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin
from simkit_navigation.plugins.navigation.velocity_command import VelocityCommand

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_INVALID_CONTROLLER: Final = 101  # error codes of nav2_msgs/action/FollowPath
_TF_ERROR: Final = 102
_INVALID_PATH: Final = 103
_PATIENCE_EXCEEDED: Final = 104
_FAILED_TO_MAKE_PROGRESS: Final = 105
_NO_VALID_CONTROL: Final = 106
_CONTROLLERS: Final[dict[str, type[Controller]]] = {
    "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController": PurePursuit,
    "nav2_pure_pursuit_controller::PurePursuitController": PurePursuitController,
}
_METHODS: Final = ("compute_velocity_commands", "set_plan")
_DEFAULT: Final = {"FollowPath": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"}


class Controller(Protocol):
    """Controller that follows a path; a class of a user needs only `set_plan` and `compute_velocity_commands`."""

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters of the controller; called once.

        Args:
            node: plugin of the controller.
            params: block of parameters with the name of the controller.
        """

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""

    def compute_velocity_commands(self, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None) -> Speeds | None:
        """Return forward speed [m/s] and turning rate [rad/s]; None if there is no safe command.

        Args:
            pose: pose of the robot in the frame of the path.
            velocity: measured forward speed [m/s] and turning rate [rad/s].
            grid: costs around the robot, in the frame of the path; None before the first costmap.
        """


class ProgressCheckerOptions(Options):
    """Options of the progress checker (`nav2_controller::PoseProgressChecker`); the angle counts at the goal only."""

    required_movement_radius: float = number(0.5, "m", minimum=0)
    required_movement_angle: float = number(0.5, "rad", minimum=0)
    movement_time_allowance: float = number(10.0, "s", minimum=0)


class GoalCheckerOptions(Options):
    """Options of the goal checker (`nav2_controller::SimpleGoalChecker`)."""

    xy_goal_tolerance: float = number(0.25, "m", minimum=0)
    yaw_goal_tolerance: float = number(0.25, "rad", minimum=0)
    stateful: bool = boolean(True)


class ControllerServerOptions(Options):
    """Options of `ControllerServer`."""

    controller_frequency: float = number(20.0, "Hz", minimum=0.1, maximum=1000)
    controller_plugins: tuple[str, ...] = texts()
    failure_tolerance: float = number(0.0, "s", minimum=0)
    progress_checker: ProgressCheckerOptions = block(ProgressCheckerOptions)
    general_goal_checker: GoalCheckerOptions = block(GoalCheckerOptions)
    odom_topic: str = text("odom")
    costmap_topic: str = text("local_costmap/costmap_raw")
    robot_base_frame: str = text("base_footprint")
    robot_radius: float = number(0.1, "m", minimum=0)
    footprint: str = text("")
    enable_stamped_cmd_vel: bool = boolean(False)


class ControllerServer(CostmapReader, ServerPlugin):
    """Follows paths: action `follow_path`; velocities go to `cmd_vel`.

    Each name in `<controller_plugins>` is a controller, with a block of parameters of the same name. Its `<plugin>` is
    a class of Nav2, or `file.py:Class`. A goal succeeds within the tolerances of `<general_goal_checker>`. It is
    aborted if the robot does not move by the distance of `<progress_checker>` in its time, or if the controller has no
    valid command for longer than `<failure_tolerance>`.
    """

    filenames = ("libsimkit_controller_server.so",)
    names = ("simkit::ControllerServer", "nav2_controller::ControllerServer")
    executable = "controller_server"
    options = OptionsOf(ControllerServerOptions)
    option_types = (PurePursuitOptions, PurePursuitControllerOptions)
    endpoints = (
        listens("odom", ODOMETRY, named_by=("odom_topic",)),
        listens("local_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),
    )
    before_step_rate = NEVER

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        options.progress_checker.read_all()
        options.general_goal_checker.read_all()
        self.controller_frequency = options.controller_frequency
        self.footprint: Footprint = read_footprint(self, options.footprint, options.robot_radius)
        self.make_parts(options.controller_plugins, _DEFAULT, _CONTROLLERS, _METHODS, "configure")
        self.is_at_goal_position = False
        self._velocity: Speeds = (0.0, 0.0)
        self._goal: GoalHandle | None = None
        self._controller_name = self._frame = ""
        self._end = PlanarPose(0.0, 0.0, 0.0)
        self._valid_ns = 0  # time of the newest valid command
        self._moved = 0, self._end  # time [ns] and pose from which progress is measured
        self.read_costmap(options.costmap_topic)
        self.subscribe(options.odom_topic, self._on_odometry)
        self._command = VelocityCommand(self, options.robot_base_frame if options.enable_stamped_cmd_vel else None)
        self.act("follow_path", "nav2_msgs/action/FollowPath", self._on_goal, self._on_cancel)

    # ------------------------------------------------------------------ messages

    def _on_odometry(self, message: msgs.Odometry) -> None:
        if not self._once.has_type(message, ODOMETRY, "odom_topic"):
            return
        twist = message.twist.twist
        if math.isfinite(twist.linear.x) and math.isfinite(twist.angular.z):
            self._velocity = twist.linear.x, twist.angular.z

    def _on_goal(self, goal: GoalHandle) -> None:
        request = goal.request
        name = request.controller_id or next(iter(self.parts), "")
        poses = poses_of_path(request.path)
        frame = request.path.header.frame_id
        pose = self._pose_in(frame)
        reason, code = "", 0
        if name not in self.parts:
            reason, code = f"no controller {name!r}; there are: {', '.join(self.parts)}", _INVALID_CONTROLLER
        elif poses is None or not len(poses):
            reason, code = "the path is empty, or contains NaN or infinite numbers", _INVALID_PATH
        elif pose is None:
            reason, code = f"the pose of {self.options.robot_base_frame!r} in {frame!r} is not known", _TF_ERROR
        if code or poses is None or pose is None:
            goal.abort({"error_code": code, "error_msg": reason}, reason)
            return
        is_new = self._goal is None
        if self._goal is not None:
            self._goal.abort(reason="another path replaced this one")
        end = PlanarPose(*poses[-1].tolist())
        if is_new or end != self._end:
            self.is_at_goal_position = False
        if is_new:
            self._valid_ns, self._moved = self.sim.time_ns, (self.sim.time_ns, pose)
        self._goal, self._controller_name, self._frame, self._end = goal, name, frame, end
        self.parts[name].set_plan(poses)
        self._set_before_step_rate(self.options.controller_frequency)

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is self._goal:
            self._stop()
        goal.canceled()

    # ------------------------------------------------------------------ control

    def _pose_in(self, frame: str) -> PlanarPose | None:
        return look_up(self.sim, frame, self.options.robot_base_frame)

    def before_step(self) -> None:
        goal = self._goal
        if goal is None:
            return
        pose = self._pose_in(self._frame)
        if pose is None:
            self._fail(goal, _TF_ERROR, f"the pose of the robot in {self._frame!r} is not known any more")
        elif self._is_reached(pose):
            self._stop()
            goal.succeed()
        elif not self._makes_progress(pose):
            self._fail(goal, _FAILED_TO_MAKE_PROGRESS, "the robot makes no progress")
        else:
            self._drive(goal, pose)

    def _drive(self, goal: GoalHandle, pose: PlanarPose) -> None:
        """Publish the velocity of the controller."""
        grid = self.grid
        placed = None if grid is None else look_up(self.sim, self._frame, grid.frame)
        seen = None if grid is None or placed is None else grid.seen_from(self._frame, placed)
        controller = self.parts[self._controller_name]
        speeds = _checked(controller.compute_velocity_commands(pose, self._velocity, seen))
        now, tolerance = self.sim.time_ns, self.options.failure_tolerance
        if speeds is None:
            if now - self._valid_ns >= tolerance * 1e9:
                code = _PATIENCE_EXCEEDED if tolerance else _NO_VALID_CONTROL
                self._fail(goal, code, "the controller found no valid command; an obstacle may be ahead")
                return
            speeds = 0.0, 0.0
        else:
            self._valid_ns = now
        self._publish(speeds)
        distance = math.hypot(self._end.x - pose.x, self._end.y - pose.y)
        goal.publish_feedback({"distance_to_goal": distance, "speed": abs(speeds[0])})

    def _is_reached(self, pose: PlanarPose) -> bool:
        """Check the tolerances of the goal; a stateful checker checks the position once."""
        checker, end = self.options.general_goal_checker, self._end
        is_near = math.hypot(end.x - pose.x, end.y - pose.y) <= checker.xy_goal_tolerance
        self.is_at_goal_position = is_near or (checker.stateful and self.is_at_goal_position)
        return self.is_at_goal_position and abs(wrap_angle(end.yaw - pose.yaw)) <= checker.yaw_goal_tolerance

    def _makes_progress(self, pose: PlanarPose) -> bool:
        begin, before = self._moved
        checker = self.options.progress_checker
        if self.is_at_goal_position:
            moves = abs(wrap_angle(pose.yaw - before.yaw)) > checker.required_movement_angle
        else:
            moves = math.hypot(pose.x - before.x, pose.y - before.y) > checker.required_movement_radius
        if moves:
            self._moved = self.sim.time_ns, pose
        return moves or self.sim.time_ns - begin <= checker.movement_time_allowance * 1e9

    def _publish(self, speeds: Speeds) -> None:
        self._command.publish(speeds)

    def _fail(self, goal: GoalHandle, code: int, reason: str) -> None:
        self._stop()
        goal.abort({"error_code": code, "error_msg": reason}, reason)

    def _stop(self) -> None:
        self._goal = None
        self._publish((0.0, 0.0))
        self._set_before_step_rate(NEVER)


def _checked(result: object) -> Speeds | None:
    """Return the result of a controller.

    Raises:
        ValueError: the result is neither None nor two finite numbers.
    """
    if result is None:
        return None
    try:
        speeds = np.asarray(result, np.float64)
    except (TypeError, ValueError):
        speeds = np.zeros(0)
    if speeds.shape != (2,) or not np.isfinite(speeds).all():
        raise ValueError("compute_velocity_commands must return (forward speed, turning rate), finite, or None")
    return float(speeds[0]), float(speeds[1])
