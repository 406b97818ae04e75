"""Plugin that follows paths, as Nav2's `nav2_controller`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from simkit import Params, msgs
from simkit.extend import (
    NEVER,
    Options,
    OptionsOf,
    block,
    boolean,
    listens,
    number,
    publishes,
    text,
    texts,
    without_effect,
)
from simkit.plugins.drives.odometry_messages import ODOMETRY
from simkit_navigation.plugins.controllers.controller_node import ControllerNode
from simkit_navigation.plugins.controllers.controller_parameters import controller_parameters
from simkit_navigation.plugins.controllers.controller_topics import TOPICS, ControllerTopics
from simkit_navigation.plugins.controllers.dwb_options import DwbCriticOptions, DwbOptions
from simkit_navigation.plugins.controllers.goal_checkers import GOAL_CHECKERS, GoalCheckerOptions, PositionGoalChecker
from simkit_navigation.plugins.controllers.graceful_controller import GracefulOptions
from simkit_navigation.plugins.controllers.local_path import distances_along
from simkit_navigation.plugins.controllers.mppi_critics import CRITICS as MPPI_CRITICS
from simkit_navigation.plugins.controllers.mppi_options import MppiOptions
from simkit_navigation.plugins.controllers.progress_checkers import (
    PROGRESS_CHECKERS,
    ProgressCheckerOptions,
    SimpleProgressChecker,
)
from simkit_navigation.plugins.controllers.pure_pursuit import PurePursuitOptions, Speeds
from simkit_navigation.plugins.controllers.rotation_shim import CONTROLLERS, RotationShimOptions
from simkit_navigation.plugins.controllers.tutorial_pure_pursuit import PurePursuitControllerOptions
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.costmaps.footprint import Footprint, read_footprint
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, split_names
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose, look_up, poses_of_path
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
_UNKNOWN: Final = 100
_CONTROLLER_TIMED_OUT: Final = 107
_NO_LIMIT: Final = -1.0  # of the failure tolerance
_CHECKERS: Final = {
    "general_goal_checker": "nav2_controller::SimpleGoalChecker",
    "progress_checker": "nav2_controller::PoseProgressChecker",
}
"""Class of a checker without `<plugin>`."""
SPEED_LIMIT: Final = "nav2_msgs/msg/SpeedLimit"
_METHODS: Final = ("compute_velocity_commands", "set_plan")
_DEFAULT: Final = {"FollowPath": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"}


class Controller(Protocol):
    """Controller that follows a path; a class of a user needs only `set_plan` and `compute_velocity_commands`.

    Optional methods are `set_speed_limit(limit, is_percentage)`, `reset()`, called at the end of each goal, and
    `cancel()`, which returns False while the robot still has to decelerate. Optional attributes are `needs_costmap`,
    true for a controller that is not asked without a costmap, and `topics`, the names of those of `TOPICS` on which it
    publishes.
    """

    def configure(self, node: ControllerNode, params: Params) -> None:
        """Read the parameters of the controller; called once.

        Args:
            node: plugin of the controller.
            params: block of parameters with the name of the controller.
        """

    def set_plan(self, path: Floats) -> None:
        """Follow another path: x, y [m] and yaw [rad] of each pose, shape (n, 3)."""

    def compute_velocity_commands(
        self, pose: PlanarPose, velocity: Speeds, grid: CostGrid | None
    ) -> tuple[float, ...] | None:
        """Return forward speed [m/s] and turning rate [rad/s]; None if there is no safe command.

        A controller of a robot that moves sideways returns three numbers; the second is the speed to the left [m/s].

        Args:
            pose: pose of the robot in the frame of the path.
            velocity: measured forward speed [m/s] and turning rate [rad/s].
            grid: costs around the robot, in the frame of the path; None before the first costmap.
        """


class InflationOptions(Options):
    """Parameters of the costmap's inflation layer that the controllers need."""

    cost_scaling_factor: float = number(10.0, "1/m", minimum=0)
    inflation_radius: float = number(0.55, "m", minimum=0)


class ControllerServerOptions(Options):
    """Options of `ControllerServer`."""

    controller_frequency: float = number(20.0, "Hz", minimum=0.1, maximum=1000)
    controller_plugins: tuple[str, ...] = texts()
    goal_checker_plugins: tuple[str, ...] = texts()
    progress_checker_plugins: tuple[str, ...] = texts()
    failure_tolerance: float = number(0.0, "s", minimum=-1, description="-1 for no limit")
    min_x_velocity_threshold: float = number(0.0001, "m/s", minimum=0)
    min_y_velocity_threshold: float = number(0.0001, "m/s", minimum=0)
    min_theta_velocity_threshold: float = number(0.0001, "rad/s", minimum=0)
    progress_checker: ProgressCheckerOptions = block(ProgressCheckerOptions)
    general_goal_checker: GoalCheckerOptions = block(GoalCheckerOptions)
    odom_topic: str = text("odom")
    speed_limit_topic: str = text("speed_limit")
    costmap_topic: str = text("local_costmap/costmap_raw")
    costmap_update_timeout: float = number(0.3, "s", minimum=0)
    track_unknown_space: bool = boolean(False)
    inflation_layer: InflationOptions = block(InflationOptions)
    robot_base_frame: str = text("base_footprint")
    robot_radius: float = number(0.1, "m", minimum=0)
    footprint: str = text("")
    publish_zero_velocity: bool = boolean(True)
    enable_stamped_cmd_vel: bool = boolean(False)
    use_realtime_priority: bool = without_effect()


class ControllerServer(ControllerTopics, CostmapReader, ServerPlugin):
    """Follows paths: action `follow_path`; velocities go to `cmd_vel`.

    Each name in `<controller_plugins>` is a controller, with a block of parameters of the same name. Its `<plugin>` is
    a class of Nav2, or `file.py:Class`. The names in `<goal_checker_plugins>` and `<progress_checker_plugins>` are
    checkers; a goal may select one of each, and without these lists they are `<general_goal_checker>` and
    `<progress_checker>`. A goal succeeds within the tolerances of its goal checker. It is aborted if the robot does not
    move by the distance of the progress checker in its time, or if the controller has no valid command for longer than
    `<failure_tolerance>`. Messages on `speed_limit` reduce the speeds of the controllers.
    """

    filenames = ("libsimkit_controller_server.so",)
    names = ("simkit::ControllerServer", "nav2_controller::ControllerServer")
    costmap = "local_costmap"
    options = OptionsOf(ControllerServerOptions)
    option_types = (
        PurePursuitOptions,
        RotationShimOptions,
        GracefulOptions,
        PurePursuitControllerOptions,
        MppiOptions,
        *dict.fromkeys(critic.kind for critic in MPPI_CRITICS.values()),
        DwbOptions,
        DwbCriticOptions,
        GoalCheckerOptions,
        ProgressCheckerOptions,
    )
    endpoints = (
        listens("odom", ODOMETRY, named_by=("odom_topic",)),
        listens("speed_limit", SPEED_LIMIT, named_by=("speed_limit_topic",)),
        listens("local_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),
        *(publishes(topic, kind) for topic, kind in TOPICS.items()),
    )
    before_step_rate = NEVER

    @classmethod
    def translate_parameters(cls, values: Values, costmap: Values, /) -> NodeValues:
        return controller_parameters(values, costmap)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        inflation = options.inflation_layer.read_all()
        self.cost_scaling_factor, self.inflation_radius = inflation.cost_scaling_factor, inflation.inflation_radius
        self.tracks_unknown_space = options.track_unknown_space
        self.controller_frequency = options.controller_frequency
        self.footprint: Footprint = read_footprint(self, options.footprint, options.robot_radius)
        goal_checkers = self._make_checkers(options.goal_checker_plugins, "general_goal_checker", GOAL_CHECKERS)
        progress_checkers = self._make_checkers(options.progress_checker_plugins, "progress_checker", PROGRESS_CHECKERS)
        self._goal_checkers: dict[str, PositionGoalChecker] = goal_checkers
        self._progress_checkers: dict[str, SimpleProgressChecker] = progress_checkers
        self.is_at_goal_position = False
        self.goal_tolerance = self.lateral_speed = 0.0
        self.make_parts(options.controller_plugins, _DEFAULT, CONTROLLERS, _METHODS, "configure")
        self._velocity: Speeds = (0.0, 0.0)
        self._goal: GoalHandle | None = None
        self._controller_name = self._checker_name = self._progress_name = self._frame = ""
        self._poses = np.zeros((1, 3))
        self._distances = np.zeros(1)  # along the path from its begin [m]
        self._begin_ns = self._valid_ns = 0  # time of the goal, and of the newest valid command
        self._is_canceling = False
        self.read_costmap(options.costmap_topic)
        self.subscribe(options.odom_topic, self._on_odometry)
        self.receive(options.speed_limit_topic, SPEED_LIMIT, "speed_limit_topic", self._on_speed_limit)
        self._command = VelocityCommand(self, options.robot_base_frame if options.enable_stamped_cmd_vel else None)
        self.open_topics([topic for part in self.parts.values() for topic in getattr(part, "topics", ())])
        self.act("follow_path", "nav2_msgs/action/FollowPath", self._on_goal, self._on_cancel)

    def _make_checkers(self, texts_of_names: tuple[str, ...], default: str, known: Mapping[str, type[Any]]) -> Any:
        """Return the checkers of a list of names.

        Args:
            texts_of_names: list of names; empty for `default` only.
            default: name of the only checker without a list.
            known: classes by their name in Nav2.
        """
        checkers = {}
        for name in split_names(texts_of_names) or [default]:
            block = self.params.block(name)
            wanted = block.text("plugin", _CHECKERS[default]).replace("/", "::")
            if wanted not in known:
                self.params.error("SK-PARAM-002", f"{name}: found {wanted!r}", f"the classes are {', '.join(known)}")
                continue
            checkers[name] = known[wanted](block)
        return checkers

    # ------------------------------------------------------------------ messages

    def _on_odometry(self, message: msgs.Odometry) -> None:
        if not self._once.has_type(message, ODOMETRY, "odom_topic"):
            return
        speeds, options = message.twist.twist, self.options
        x, y, rate = speeds.linear.x, speeds.linear.y, speeds.angular.z
        if math.isfinite(x) and math.isfinite(y) and math.isfinite(rate):
            self._velocity = (
                x if abs(x) > options.min_x_velocity_threshold else 0.0,
                rate if abs(rate) > options.min_theta_velocity_threshold else 0.0,
            )
            self.lateral_speed = y if abs(y) > options.min_y_velocity_threshold else 0.0

    def _on_speed_limit(self, message: msgs.SpeedLimit) -> None:
        if not (math.isfinite(message.speed_limit) and message.speed_limit >= 0.0):
            self._once.left_out("speed_limit", "a speed limit is ignored that is negative, NaN or infinite")
            return
        for part in self.parts.values():
            if callable(getattr(part, "set_speed_limit", None)):
                part.set_speed_limit(message.speed_limit, message.percentage)

    def _on_goal(self, goal: GoalHandle) -> None:
        request = goal.request
        poses = poses_of_path(request.path)
        frame = request.path.header.frame_id
        pose = self._pose_in(frame)
        names, reason, code = [], "", 0
        for wanted, known, what, failure in (
            (request.controller_id, self.parts, "controller", _INVALID_CONTROLLER),
            (request.goal_checker_id, self._goal_checkers, "goal checker", _UNKNOWN),
            (request.progress_checker_id, self._progress_checkers, "progress checker", _UNKNOWN),
        ):
            names.append(wanted or next(iter(known), ""))
            if names[-1] not in known and not code:
                reason, code = f"no {what} {names[-1]!r}; there are: {', '.join(known)}", failure
        if code:
            pass
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
        has_other_end = is_new or bool((poses[-1] != self._poses[-1]).any()) or names[1] != self._checker_name
        if is_new:
            self._begin_ns = self._valid_ns = self.sim.time_ns
        if is_new or names[2] != self._progress_name:
            self._progress_checkers[names[2]].reset()
        self._controller_name, self._checker_name, self._progress_name = names
        checker = self._goal_checkers[self._checker_name]
        if has_other_end:  # Nav2 resets the checker at each path, so that a robot at its goal begins to drive again
            checker.reset()
            self.is_at_goal_position = False
        self.goal_tolerance = checker.options.xy_goal_tolerance
        self._goal, self._frame, self._poses, self._distances = goal, frame, poses, distances_along(poses)
        self._is_canceling = False
        self.parts[self._controller_name].set_plan(poses)
        self._set_before_step_rate(self.options.controller_frequency)

    def _on_cancel(self, goal: GoalHandle) -> None:
        if goal is self._goal:
            cancel = getattr(self.parts[self._controller_name], "cancel", None)
            if callable(cancel) and not cancel():
                self._is_canceling = True  # the controller decelerates first
                return
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
        elif not self._progress_checkers[self._progress_name].makes_progress(pose, self.sim.time_ns):
            self._fail(goal, _FAILED_TO_MAKE_PROGRESS, "the robot makes no progress")
        else:
            self._drive(goal, pose)
            if self._is_canceling and self._goal is goal and self.parts[self._controller_name].cancel():
                self._stop()
                goal.canceled()

    def _drive(self, goal: GoalHandle, pose: PlanarPose) -> None:
        """Publish the velocity of the controller."""
        grid = self.grid
        placed = None if grid is None else look_up(self.sim, self._frame, grid.frame)
        seen = None if grid is None or placed is None else grid.seen_from(self._frame, placed)
        self.place_topics(self._frame if grid is None or placed is None else grid.frame, placed)
        controller = self.parts[self._controller_name]
        now, tolerance = self.sim.time_ns, self.options.failure_tolerance
        if seen is None and getattr(controller, "needs_costmap", False):
            self._valid_ns = now
            if now - self._begin_ns > self.options.costmap_update_timeout * 1e9:
                self._fail(goal, _CONTROLLER_TIMED_OUT, f"there is no costmap on {self.options.costmap_topic!r}")
            return
        speeds = _checked(controller.compute_velocity_commands(pose, self._velocity, seen))
        if speeds is None:
            if tolerance != _NO_LIMIT and now - self._valid_ns >= tolerance * 1e9:
                code = _PATIENCE_EXCEEDED if tolerance else _NO_VALID_CONTROL
                self._fail(goal, code, "the controller found no valid command; an obstacle may be ahead")
                return
            speeds = 0.0, 0.0
        else:
            self._valid_ns = now
        self._command.publish(speeds)
        speed = math.hypot(*speeds[:-1])
        goal.publish_feedback({"distance_to_goal": self._remaining(pose), "speed": speed})

    def _remaining(self, pose: PlanarPose) -> float:
        """Return the length of the path from its pose nearest to the robot on [m]; of a straight way near the end."""
        poses = self._poses
        nearest = int(((poses[:, 0] - pose.x) ** 2 + (poses[:, 1] - pose.y) ** 2).argmin())
        straight = math.hypot(poses[-1, 0] - pose.x, poses[-1, 1] - pose.y)
        return max(float(self._distances[-1] - self._distances[nearest]), straight)

    def _is_reached(self, pose: PlanarPose) -> bool:
        """Ask the goal checker."""
        checker = self._goal_checkers[self._checker_name]
        end = PlanarPose(*self._poses[-1].tolist())
        speeds = self._velocity[0], self.lateral_speed, self._velocity[1]
        is_reached = checker.is_reached(pose, end, speeds, self._remaining(pose))
        self.is_at_goal_position = checker.is_at_position
        return is_reached

    def _fail(self, goal: GoalHandle, code: int, reason: str) -> None:
        self._stop()
        self.log.warning("path not followed: %s", reason)
        goal.abort({"error_code": code, "error_msg": reason}, reason)

    def _stop(self) -> None:
        self._goal, self._is_canceling = None, False
        if self.options.publish_zero_velocity:
            self._command.publish((0.0, 0.0))
        for part in self.parts.values():
            if callable(getattr(part, "reset", None)):
                part.reset()
        self._set_before_step_rate(NEVER)


def _checked(result: object) -> tuple[float, ...] | None:
    """Return the result of a controller.

    Raises:
        ValueError: the result is neither None nor two or three finite numbers.
    """
    if result is None:
        return None
    try:
        speeds = np.asarray(result, np.float64)
    except (TypeError, ValueError):
        speeds = np.zeros(0)
    if speeds.shape not in ((2,), (3,)) or not np.isfinite(speeds).all():
        raise ValueError(
            "compute_velocity_commands must return (forward speed, turning rate) or (forward speed, speed to the left, "
            "turning rate), finite, or None"
        )
    return tuple(speeds.tolist())
