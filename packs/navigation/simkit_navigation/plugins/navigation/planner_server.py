"""Plugin that plans paths on a costmap, as Nav2's `nav2_planner`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias

import numpy as np

from simkit import Params, Plugin, msgs
from simkit.elementary_functions import arctan2
from simkit.extend import Options, OptionsOf, listens, text, texts
from simkit_navigation.plugins.navigation.cost_grid import CostGrid
from simkit_navigation.plugins.navigation.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.navigation.grid_planner import GridPlanner, GridPlannerOptions
from simkit_navigation.plugins.navigation.planar_pose import (
    Floats,
    PlanarPose,
    look_up,
    path_message,
    pose_of_message,
    poses_of_path,
)
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_INVALID_PLANNER: Final = 201  # error codes of nav2_msgs/action/ComputePathToPose
_TF_ERROR: Final = 202
_START_OUTSIDE_MAP: Final = 203
_GOAL_OUTSIDE_MAP: Final = 204
_NO_VALID_PATH: Final = 208
_PLANNERS: Final[dict[str, type[GlobalPlanner]]] = {
    "nav2_navfn_planner::NavfnPlanner": GridPlanner,
}
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
    costmap_topic: str = text("global_costmap/costmap_raw")
    robot_base_frame: str = text("base_footprint")


class _NoPlanError(Exception):
    """A path cannot be computed.

    Attributes:
        code: error code of `nav2_msgs/action/ComputePathToPose`.
    """

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class PlannerServer(CostmapReader, ServerPlugin):
    """Plans paths: action `compute_path_to_pose`, service `is_path_valid`; the newest path is on `plan`.

    Each name in `<planner_plugins>` is a planner, with a block of parameters of the same name. Its `<plugin>` is a
    class of Nav2, or `file.py:Class`. A goal selects a planner by `planner_id`; without it, the first planner is used.
    A plan takes no simulated time, so `planning_time` is 0.
    """

    filenames = ("libsimkit_planner_server.so",)
    names = ("simkit::PlannerServer", "nav2_planner::PlannerServer")
    executable = "planner_server"
    options = OptionsOf(PlannerServerOptions)
    option_types = (GridPlannerOptions,)
    endpoints = (listens("global_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),)

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self.make_parts(options.planner_plugins, _DEFAULT, _PLANNERS, ("create_plan",), "configure")
        self.read_costmap(options.costmap_topic)
        self._plan = self.advertise("plan", "nav_msgs/msg/Path")
        self.act("compute_path_to_pose", "nav2_msgs/action/ComputePathToPose", self._on_goal)
        self.offer("is_path_valid", "nav2_msgs/srv/IsPathValid", self._on_is_path_valid)

    def _on_goal(self, goal: GoalHandle) -> None:
        try:
            poses, frame = self._path_for(goal.request)
        except _NoPlanError as error:
            self.log.warning("no path: %s", error)
            goal.abort({"error_code": error.code, "error_msg": str(error)}, str(error))
            return
        path = path_message(poses, msgs.header(self.sim.time_ns, frame))
        self._plan.publish(path)
        goal.succeed({"path": path})

    def _path_for(self, request: msgs.ComputePathToPose_Goal) -> tuple[Floats, str]:
        """Return the path of a request, shape (n, 3) [m, rad], and its frame.

        Raises:
            _NoPlanError: there is no path.
        """
        name = request.planner_id or next(iter(self.parts), "")
        planner = self.parts.get(name)
        if planner is None:
            raise _NoPlanError(_INVALID_PLANNER, f"no planner {name!r}; the planners are: {', '.join(self.parts)}")
        grid = self.grid
        if grid is None:
            raise _NoPlanError(_TF_ERROR, f"no costmap on {self.ros.topic(self.options.costmap_topic)} yet")
        if request.use_start:
            start = self._in_frame_of(grid, request.start)
        else:
            start = look_up(self.sim, grid.frame, self.options.robot_base_frame)
        end = self._in_frame_of(grid, request.goal)
        if start is None or end is None:
            raise _NoPlanError(_TF_ERROR, f"the {'start' if start is None else 'goal'} is not known in {grid.frame!r}")
        for pose, code, title in ((start, _START_OUTSIDE_MAP, "start"), (end, _GOAL_OUTSIDE_MAP, "goal")):
            if grid.to_cell(pose.x, pose.y) is None:
                raise _NoPlanError(code, f"the {title} ({pose.x:.4g}, {pose.y:.4g}) is outside of the costmap")
        poses = _as_poses(planner.create_plan(grid, start, end), end.yaw)
        if poses is None:
            raise _NoPlanError(_NO_VALID_PATH, f"{name} found no path to ({end.x:.4g}, {end.y:.4g})")
        return poses, grid.frame

    def _in_frame_of(self, grid: CostGrid, stamped: msgs.PoseStamped) -> PlanarPose | None:
        """Return a stamped pose in the frame of the costmap; None if it is not known there."""
        pose = pose_of_message(stamped.pose)
        frame = look_up(self.sim, grid.frame, stamped.header.frame_id or grid.frame)
        return None if pose is None or frame is None else frame.compose(pose)

    def _on_is_path_valid(self, request: msgs.IsPathValid_Request) -> dict[str, object]:
        """Check whether a path touches no obstacle."""
        poses = poses_of_path(request.path)
        if self.grid is None or poses is None or not len(poses):
            return {"is_valid": False}
        invalid = np.flatnonzero(self.grid.is_blocked(poses[:, :2]))
        return {"is_valid": not len(invalid), "invalid_pose_indices": invalid.astype(np.int32)}


def _as_poses(path: PlannedPath | None, last: float) -> Floats | None:
    """Return what a planner has returned as poses, shape (n, 3) [m, rad]; None if there is no path.

    Poses without yaw look at their next pose, and the last one has a given yaw.

    Raises:
        ValueError: the planner returned something else.
    """
    try:
        poses = np.array([] if path is None else [tuple(pose) for pose in path], np.float64)
    except (TypeError, ValueError):
        poses = np.zeros((1, 0))
    if not len(poses):
        return None
    if poses.ndim != 2 or poses.shape[1] not in (2, 3) or not np.isfinite(poses).all():
        raise ValueError("create_plan must return finite (x, y) or (x, y, yaw) for each pose of the path")
    if poses.shape[1] == 3:
        return poses
    ahead = np.diff(poses, axis=0)
    return np.column_stack((poses, [*arctan2(ahead[:, 1], ahead[:, 0]).tolist(), last]))
