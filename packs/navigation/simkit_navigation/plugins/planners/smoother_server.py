"""Plugin that smooths paths, as Nav2's `nav2_smoother`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, msgs
from simkit.extend import Options, OptionsOf, listens, text, texts
from simkit_navigation.plugins.costmaps.cost_grid import LETHAL, CostGrid
from simkit_navigation.plugins.costmaps.costmap_reader import COSTMAP, CostmapReader
from simkit_navigation.plugins.costmaps.footprint import edge_points
from simkit_navigation.plugins.navigation.node_values import NodeValues, Values, names_of
from simkit_navigation.plugins.navigation.planar_pose import (
    Floats,
    PlanarPose,
    look_up,
    path_message,
    poses_of_path,
)
from simkit_navigation.plugins.navigation.user_classes import ServerPlugin
from simkit_navigation.plugins.planners.path_smoothing import poses_of_result
from simkit_navigation.plugins.planners.smoothers import (
    SavitzkyGolaySmoother,
    SavitzkyGolaySmootherOptions,
    SimpleSmoother,
    SimpleSmootherOptions,
    Smoother,
)

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import GoalHandle

_POLYGON: Final = "geometry_msgs/msg/PolygonStamped"
_UNKNOWN: Final = 500  # error codes of nav2_msgs/action/SmoothPath
_INVALID_SMOOTHER: Final = 501
_SMOOTHED_PATH_IN_COLLISION: Final = 503
_FAILED_TO_SMOOTH_PATH: Final = 504
_INVALID_PATH: Final = 505
_SIMPLE: Final = "nav2_smoother::SimpleSmoother"

SMOOTHERS: Final[dict[str, type[Smoother]]] = {
    _SIMPLE: SimpleSmoother,
    "nav2_smoother::SavitzkyGolaySmoother": SavitzkyGolaySmoother,
}
"""Smoothers by their names in Nav2."""

REPLACED_SMOOTHERS: Final = {
    "nav2_constrained_smoother::ConstrainedSmoother": (
        _SIMPLE,
        "curvature and distance from obstacles are not optimised",
    )
}
"""Names of smoothers that simkit does not have, with the name of the smoother in their place, and what it changes."""

_DEFAULT: Final = {"simple_smoother": _SIMPLE}


class SmootherServerOptions(Options):
    """Options of `SmootherServer`."""

    smoother_plugins: tuple[str, ...] = texts()
    costmap_topic: str = text("global_costmap/costmap_raw")
    footprint_topic: str = text("global_costmap/published_footprint")
    robot_base_frame: str = text("base_footprint")


class _SmoothingError(Exception):
    """A path cannot be smoothed.

    Attributes:
        code: error code of `nav2_msgs/action/SmoothPath`.
    """

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class SmootherServer(CostmapReader, ServerPlugin):
    """Smooths paths: action `smooth_path`; the newest path is on `plan_smoothed`.

    Each name in `<smoother_plugins>` is a smoother, with a block of parameters of the same name. Its `<plugin>` is a
    class of Nav2, or `file.py:Class`. A goal selects a smoother by `smoother_id`; without it, the first one is used.
    With `check_for_collisions`, a goal is aborted if the outline of the robot, which comes from `<footprint_topic>`,
    touches an obstacle or an unknown cell at a pose of the path. Smoothing takes no simulated time.
    """

    filenames = ("libsimkit_smoother_server.so",)
    names = ("simkit::SmootherServer", "nav2_smoother::SmootherServer")
    options = OptionsOf(SmootherServerOptions)
    option_types = (SimpleSmootherOptions, SavitzkyGolaySmootherOptions)
    endpoints = (
        listens("global_costmap/costmap_raw", COSTMAP, named_by=("costmap_topic",)),
        listens("global_costmap/published_footprint", _POLYGON, named_by=("footprint_topic",)),
    )

    @classmethod
    def translate_parameters(cls, values: Values, _: Values, /) -> NodeValues:
        return NodeValues({"robot_base_frame": "base_link", **values}, names_of(values.get("smoother_plugins")))

    def load(self, parent: Simulation | Model, params: Params) -> None:
        options = self.options.read_all()
        self.sim.tf.open()  # so that the first look-up knows the transforms before it
        self.make_parts(options.smoother_plugins, _DEFAULT, SMOOTHERS, ("smooth",), "configure", REPLACED_SMOOTHERS)
        self._outline: msgs.PolygonStamped | None = None
        self.read_costmap(options.costmap_topic)
        self.receive(options.footprint_topic, _POLYGON, "footprint_topic", self._on_outline)
        self._plan = self.advertise("plan_smoothed", "nav_msgs/msg/Path")
        self.act("smooth_path", "nav2_msgs/action/SmoothPath", self._on_goal)

    def _on_outline(self, message: msgs.PolygonStamped) -> None:
        self._outline = message

    def _on_goal(self, goal: GoalHandle) -> None:
        try:
            path = self._smoothed(goal.request)
        except _SmoothingError as error:
            self.log.warning("no smooth path: %s", error)
            goal.abort({"error_code": error.code, "error_msg": str(error)}, str(error))
            return
        goal.succeed({"path": path, "was_completed": True})

    def _smoothed(self, request: msgs.SmoothPath_Goal) -> msgs.Path:
        name, frame = request.smoother_id or next(iter(self.parts), ""), request.path.header.frame_id
        if name not in self.parts:
            text = f"no smoother {name!r}; the smoothers are: {', '.join(self.parts)}"
            raise _SmoothingError(_INVALID_SMOOTHER, text)
        poses = poses_of_path(request.path)
        if poses is None or not len(poses):
            raise _SmoothingError(_INVALID_PATH, "the path is empty, or contains NaN or infinite numbers")
        grid = self._grid_in(frame)
        smooth = poses_of_result(self.parts[name].smooth(poses, grid), float(poses[-1, 2]), "smooth")
        if smooth is None:
            raise _SmoothingError(_FAILED_TO_SMOOTH_PATH, f"{name} returned no path")
        path = path_message(smooth, msgs.header(self.sim.time_ns, frame))
        self._plan.publish(path)
        if request.check_for_collisions:
            self._check(smooth, grid)
        return path

    def _grid_in(self, frame: str) -> CostGrid:
        """Return the costmap in the frame of a path."""
        grid = self.grid
        if grid is None:
            raise _SmoothingError(_UNKNOWN, f"no costmap on {self.ros.topic(self.options.costmap_topic)} yet")
        placed = look_up(self.sim, frame or grid.frame, grid.frame)
        if placed is None:
            raise _SmoothingError(_UNKNOWN, f"the pose of {grid.frame!r} in the path's frame {frame!r} is not known")
        return grid.seen_from(frame or grid.frame, placed)

    def _check(self, poses: Floats, grid: CostGrid) -> None:
        """Check that the robot touches no obstacle on a path, as Nav2's `CostmapTopicCollisionChecker`.

        Raises:
            _SmoothingError: it does.
        """
        outline = self._outline
        topic, base = self.ros.topic(self.options.footprint_topic), self.options.robot_base_frame
        if outline is None or not outline.polygon.points:
            raise _SmoothingError(_SMOOTHED_PATH_IN_COLLISION, f"no outline of the robot on {topic} yet")
        frame = look_up(self.sim, base, outline.header.frame_id, outline.header.stamp)
        frame = frame or look_up(self.sim, base, outline.header.frame_id)
        if frame is None:
            text = f"the frame {outline.header.frame_id!r} of {topic} is not known in {base!r}"
            raise _SmoothingError(_SMOOTHED_PATH_IN_COLLISION, text)
        corners = frame.transform(np.array([(point.x, point.y) for point in outline.polygon.points], np.float64))
        outside = edge_points(corners, grid.resolution)
        for x, y, yaw in poses.tolist():
            if (grid.costs(PlanarPose(x, y, yaw).transform(outside)) >= LETHAL).any():
                text = (
                    f"the robot touches an obstacle on the smoothed path at x = {x:.4g}, y = {y:.4g}, yaw = {yaw:.4g}"
                )
                raise _SmoothingError(_SMOOTHED_PATH_IN_COLLISION, text)
