"""Plugin that plans paths on a costmap, as Nav2's `nav2_planner`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias

import numpy as np

from simkit import Params, Plugin, msgs
from simkit.extend import NEVER, Options, OptionsOf, listens, number, text, texts, without_effect
from simkit_navigation.plugins.costmaps.cost_grid import CostGrid
from simkit_navigation.plugins.costmaps.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, names_of
from simkit_navigation.plugins.navigation.planar_pose import (
    Floats,
    PlanarPose,
    look_up,
    path_message,
    pose_of_message,
    poses_of_path,
)
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin
from simkit_navigation.plugins.planners.grid_planner import GridPlanner, GridPlannerOptions
from simkit_navigation.plugins.planners.path_smoothing import poses_of_result
from simkit_navigation.plugins.planners.planning_error import PlanningError, Reason
from simkit_navigation.plugins.planners.smac_planner_2d import (
    SmacPlanner2D,
    SmacPlanner2DOptions,
)
from simkit_navigation.plugins.planners.straight_line_planner import StraightLine, StraightLineOptions
from simkit_navigation.plugins.planners.theta_star_planner import ThetaStarPlanner, ThetaStarPlannerOptions

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_TO_POSE: Final = "nav2_msgs/action/ComputePathToPose"
_THROUGH_POSES: Final = "nav2_msgs/action/ComputePathThroughPoses"
_FIRST_CODES: Final = (200, 300)  # UNKNOWN of the two actions
_SMAC_2D: Final = "nav2_smac_planner::SmacPlanner2D"
_CHECK_RATE: Final = 20.0  # [Hz] at which the time of a goal that waits for a costmap is checked
_ONLY_2D: Final = "paths ignore the turning radius and the heading, and have no reverse motion"

PLANNERS: Final[dict[str, type[GlobalPlanner]]] = {
    "nav2_navfn_planner::NavfnPlanner": GridPlanner,
    _SMAC_2D: SmacPlanner2D,
    "nav2_theta_star_planner::ThetaStarPlanner": ThetaStarPlanner,
    "nav2_straightline_planner::StraightLine": StraightLine,
}
"""Planners by their names in Nav2."""

REPLACED_PLANNERS: Final = {
    f"nav2_smac_planner::{name}": (_SMAC_2D, _ONLY_2D)
    for name in ("SmacPlannerHybrid", "SmacPlannerLattice", "SmacPlanner")
}
"""Names of planners that simkit does not have, with the name of the planner in their place, and what it changes."""

_DEFAULT: Final = {"GridBased": "nav2_navfn_planner::NavfnPlanner"}

PlannedPath: TypeAlias = Floats | Sequence[Sequence[float]]
"""Poses of a path: (x, y) or (x, y, yaw) [m, rad] for each pose."""


class GlobalPlanner(Protocol):
    """Planner of paths; a class of a user needs only `create_plan`."""

    def configure(self, node: Plugin, params: Params) -> None:
        """Read the parameters of the planner; called once.

        Args:
            node: plugin of the planner.
            params: block of parameters with the name of the planner.
        """

    def create_plan(self, grid: CostGrid, start: PlanarPose, goal: PlanarPose) -> PlannedPath | None:
        """Return the poses of a path: (x, y) or (x, y, yaw) [m, rad] for each pose; None or empty if there is no path.

        Args:
            grid: costs.
            start: pose of the robot in the frame of the grid.
            goal: goal in the frame of the grid.
        """


class PlannerServerOptions(Options):
    """Options of `PlannerServer`."""

    planner_plugins: tuple[str, ...] = texts()
    expected_planner_frequency: bool = without_effect()  # a plan takes no simulated time, so it is never late
    costmap_update_timeout: float = number(1.0, "s", minimum=0)
    costmap_topic: str = text("global_costmap/costmap_raw")
    robot_base_frame: str = text("base_footprint")


class PlannerServer(CostmapReader, ServerPlugin):
    """Plans paths: actions `compute_path_to_pose` and `compute_path_through_poses`, service `is_path_valid`.

    The newest path is on `plan`. Each name in `<planner_plugins>` is a planner, with a block of parameters of the same
    name. Its `<plugin>` is a class of Nav2, or `file.py:Class`. A goal selects a planner by `planner_id`; without it,
    the first planner is used. A goal waits for the first costmap for `<costmap_update_timeout>`. A plan takes no
    simulated time, so `planning_time` is 0.
    """

    filenames = ("libsimkit_planner_server.so",)
    names = ("simkit::PlannerServer", "nav2_planner::PlannerServer")
    costmap = "global_costmap"
    options = OptionsOf(PlannerServerOptions)
    option_types = (
        GridPlannerOptions,
        SmacPlanner2DOptions,
        ThetaStarPlannerOptions,
        StraightLineOptions,
    )
    endpoints = (listens("global_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),)
    before_step_rate = NEVER

    @classmethod
    def translate_parameters(cls, values: Values, costmap: Values, /) -> NodeValues:
        base = costmap.get("robot_base_frame", "base_link")
        return NodeValues({"robot_base_frame": base, **values}, names_of(values.get("planner_plugins")))

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self.make_parts(options.planner_plugins, _DEFAULT, PLANNERS, ("create_plan",), "configure", REPLACED_PLANNERS)
        self._waiting: list[tuple[int, GoalHandle]] = []  # time [ns] until which each goal waits for a costmap
        self.read_costmap(options.costmap_topic)
        self._plan = self.advertise("plan", "nav_msgs/msg/Path")
        self.act("compute_path_to_pose", _TO_POSE, self._on_goal)
        self.act("compute_path_through_poses", _THROUGH_POSES, self._on_goal)
        self.offer("is_path_valid", "nav2_msgs/srv/IsPathValid", self._on_is_path_valid)

    # ------------------------------------------------------------------ goals

    def _on_goal(self, goal: GoalHandle) -> None:
        timeout = self.options.costmap_update_timeout
        if self.grid is None and timeout:
            self._waiting.append((self.sim.time_ns + round(timeout * 1e9), goal))
            self._set_before_step_rate(_CHECK_RATE)
        else:
            self._answer(goal)

    def before_step(self) -> None:
        """Answer the goals that have waited for a costmap."""
        now, waiting = self.sim.time_ns, self._waiting
        self._waiting = [(end, goal) for end, goal in waiting if self.grid is None and now < end]
        kept = [goal for _, goal in self._waiting]
        for _, goal in waiting:
            if goal not in kept and not goal.is_done:
                self._answer(goal)
        if not self._waiting:
            self._set_before_step_rate(NEVER)

    def _answer(self, goal: GoalHandle) -> None:
        is_through = hasattr(goal.request, "goals")
        targets = list(goal.request.goals) if is_through else [goal.request.goal]
        try:
            poses, frame = self._path_for(goal.request, targets)
        except PlanningError as error:
            self.log.warning("no path: %s", error)
            code = _FIRST_CODES[is_through] + error.reason
            goal.abort({"error_code": code, "error_msg": str(error)}, str(error))
            return
        path = path_message(poses, msgs.header(self.sim.time_ns, frame))
        self._plan.publish(path)
        goal.succeed({"path": path})

    def _path_for(
        self,
        request: msgs.ComputePathToPose_Goal | msgs.ComputePathThroughPoses_Goal,
        targets: Sequence[msgs.PoseStamped],
    ) -> tuple[Floats, str]:
        """Return the path of a request, shape (n, 3) [m, rad], and its frame.

        Raises:
            PlanningError: there is no path.
        """
        name = request.planner_id or next(iter(self.parts), "")
        if name not in self.parts:
            text = f"no planner {name!r}; the planners are: {', '.join(self.parts)}"
            raise PlanningError(Reason.INVALID_PLANNER, text)
        grid = self.grid
        if grid is None:
            topic, seconds = self.ros.topic(self.options.costmap_topic), self.options.costmap_update_timeout
            raise PlanningError(Reason.TIMEOUT, f"no costmap on {topic} after {seconds:g} s")
        if not targets:
            raise PlanningError(Reason.NO_VIAPOINTS_GIVEN, "the goal has no poses")
        start = self._start(grid, request)
        paths: list[Floats] = []
        for target in targets:
            part = self._plan_to(name, grid, start, self._pose_in(grid, target, "goal"))
            paths.append(part[1:] if paths else part)  # the first pose is the last one of the path before
            start = PlanarPose(*part[-1].tolist())
        return np.concatenate(paths), grid.frame

    def _start(
        self, grid: CostGrid, request: msgs.ComputePathToPose_Goal | msgs.ComputePathThroughPoses_Goal
    ) -> PlanarPose:
        if request.use_start:
            return self._pose_in(grid, request.start, "start")
        frame = self.options.robot_base_frame
        pose = look_up(self.sim, grid.frame, frame)
        if pose is None:
            raise PlanningError(Reason.TF_ERROR, f"the pose of the robot ({frame!r}) in {grid.frame!r} is not known")
        return pose

    def _pose_in(self, grid: CostGrid, stamped: msgs.PoseStamped, title: str) -> PlanarPose:
        """Return a stamped pose in the frame of the costmap.

        Raises:
            PlanningError: it is not known there.
        """
        pose, source = pose_of_message(stamped.pose), stamped.header.frame_id or grid.frame
        if pose is None:
            raise PlanningError(Reason.TF_ERROR, f"the {title} contains NaN or infinite numbers")
        frame = look_up(self.sim, grid.frame, source)
        if frame is None:
            text = f"the {title} is given in the frame {source!r}, whose pose in {grid.frame!r} is not known"
            raise PlanningError(Reason.TF_ERROR, text)
        return frame.compose(pose)

    def _plan_to(self, name: str, grid: CostGrid, start: PlanarPose, end: PlanarPose) -> Floats:
        for pose, reason, title in (
            (start, Reason.START_OUTSIDE_MAP, "start"),
            (end, Reason.GOAL_OUTSIDE_MAP, "goal"),
        ):
            if grid.to_cell(pose.x, pose.y) is None:
                raise PlanningError(reason, f"the {title} ({pose.x:.4g}, {pose.y:.4g}) is outside of the costmap")
        poses = poses_of_result(self.parts[name].create_plan(grid, start, end), end.yaw, "create_plan")
        if poses is None:
            raise PlanningError(Reason.NO_VALID_PATH, f"{name} found no path to ({end.x:.4g}, {end.y:.4g})")
        return poses

    # ------------------------------------------------------------------ paths

    def _on_is_path_valid(self, request: msgs.IsPathValid_Request) -> dict[str, object]:
        """Check whether a path touches no obstacle, from the pose that is nearest to the robot on."""
        poses, grid = poses_of_path(request.path), self.grid
        frame = None if grid is None else look_up(self.sim, grid.frame, request.path.header.frame_id or grid.frame)
        if grid is None or frame is None or poses is None or not len(poses):
            return {"is_valid": False}
        points = frame.transform(poses[:, :2])
        robot = look_up(self.sim, grid.frame, self.options.robot_base_frame)
        first = 0 if robot is None else int(np.hypot(*(points - (robot.x, robot.y)).T).argmin())
        is_inside = grid.indices(points)[2]
        invalid = np.flatnonzero(grid.is_blocked(points) | ~is_inside)
        invalid = invalid[invalid >= first]
        return {"is_valid": not len(invalid), "invalid_pose_indices": invalid.astype(np.int32)}
