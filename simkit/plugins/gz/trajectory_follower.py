"""Trajectory follower of Gazebo, which pushes a link along waypoints: `gz::sim::systems::TrajectoryFollower`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.find_entities import find_named_link, read_topic
from simkit.plugins.options import Options, OptionsOf, block, boolean, number, text, vector

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.msgs import Bool
    from simkit.pose import Pose
    from simkit.runtime import Model
    from simkit.scene import SceneModel

Point = tuple[float, float]

BOOL: Final = "std_msgs/msg/Bool"
_KINDS: Final = ("waypoints", "circle", "line")
_ON_A_CIRCLE: Final = 8
_FARTHEST: Final = 1e9  # [m]
_STRAIGHT: Final = math.radians(0.1)
"""Bearing [rad] at which `<zero_vel_on_bearing_reached>` stops the rotation."""


class TrajectoryFollowerWaypointsOptions(Options):
    """Options of the `<waypoints>` block."""

    waypoint: tuple[float, ...] = vector(None, size=2)


class TrajectoryFollowerCircleOptions(Options):
    """Options of the `<circle>` block."""

    radius: float = number(0.0, "m", minimum=0.0, maximum=1000000000.0)


class TrajectoryFollowerLineOptions(Options):
    """Options of the `<line>` block."""

    direction: float = number(0.0)
    length: float = number(0.0, "m", minimum=-1000000000.0, maximum=1000000000.0)


class TrajectoryFollowerOptions(Options):
    """Options of `TrajectoryFollower`."""

    link_name: str = text(required=True)
    waypoints: TrajectoryFollowerWaypointsOptions = block(TrajectoryFollowerWaypointsOptions)
    circle: TrajectoryFollowerCircleOptions = block(TrajectoryFollowerCircleOptions)
    line: TrajectoryFollowerLineOptions = block(TrajectoryFollowerLineOptions)
    loop: bool = boolean()
    force: float = number(60.0, "N")
    torque: float = number(50.0, "N·m")
    range_tolerance: float = number(0.5, minimum=0.0)
    bearing_tolerance: float = number(2.0, minimum=0.0, maximum=180.0)
    zero_vel_on_bearing_reached: bool = boolean()
    topic: str = text()


class TrajectoryFollower(ModelPlugin):
    """Pushes a link from waypoint to waypoint in the plane, by one force and one torque.

    While the direction to the next waypoint differs by more than `<bearing_tolerance>` from the link's x axis,
    `<torque>` turns the link around its own z axis. Otherwise `<force>` pushes the link along its own x axis. Both act
    at the centre of mass. A waypoint within `<range_tolerance>` is reached. The last waypoint stays active, so a
    displaced link returns to it. `<line>` and `<circle>` begin at the initial position of the link. On
    `/model/<model>/trajectory_follower/pause`, true pauses the motion and false continues it.

    Gazebo pushes along the axes of `<inertial><pose>`, and simkit along the link's axes. The two differ only if that
    pose is rotated.
    """

    options = OptionsOf(TrajectoryFollowerOptions)
    filenames = ("gz-sim-trajectory-follower-system",)
    names = ("gz::sim::systems::TrajectoryFollower",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, "link_name", params)
        start = next((link.pose_world for link in scene.all_links() if link.scoped == self._scoped), scene.pose_world)
        self._points = _waypoints(params, start, self.name)
        self.options.read_all()

    def load(self, parent: Model, params: Params) -> None:
        self._is_paused, self._is_held = False, False
        self._remaining = list(self._points)
        self._link = self.sim.link(self._scoped)
        if self.options.zero_vel_on_bearing_reached and not self._link.is_free:
            message = "<zero_vel_on_bearing_reached> has no effect: the link has a joint to its parent or to the world"
            self._once.warn("SK-PLUGIN-131", "held", message, "set <link_name> to the root link of the model")
        self._set_pace()
        default_topic = f"/model/{parent.name}/trajectory_follower/pause"
        self.listen(read_topic(params, "topic", default_topic), BOOL, self._on_pause)

    def _on_pause(self, message: Bool) -> None:
        self._is_paused = bool(message.data)
        self._set_pace()

    def _set_pace(self) -> None:
        """Call `before_step` at every step while the link follows waypoints, and not at all during a pause."""
        self._set_before_step_rate(NEVER if self._is_paused or not self._remaining else None)

    def before_step(self) -> None:
        if not self._remaining or self._is_paused:
            return
        pose, options = self._link.pose, self.options
        (x, y), (goal_x, goal_y) = pose.position[:2].tolist(), self._remaining[0]
        way = goal_x - x, goal_y - y, 0.0  # heights are ignored
        if math.hypot(*way) <= options.range_tolerance:
            self._activate_next_waypoint()
            return
        ahead, aside, _ = pose.inverse().rotate(way).tolist()
        bearing = math.atan2(aside, ahead)
        if abs(bearing) > math.radians(options.bearing_tolerance):
            self._is_held = False
            torque = math.copysign(1.0, bearing) * options.torque
            self._link.apply_wrench((0.0, 0.0, 0.0), pose.rotate((0.0, 0.0, torque)))
            return
        self._link.apply_wrench(pose.rotate((options.force, 0.0, 0.0)))
        if options.zero_vel_on_bearing_reached and self._link.is_free:
            # hold the rotation from bearing zero until the bearing exceeds the tolerance
            self._is_held = self._is_held or abs(bearing) <= _STRAIGHT
            if self._is_held:
                self._link.set_velocity(self._link.linear_velocity)

    def _activate_next_waypoint(self) -> None:
        """Make the next waypoint active; the last waypoint stays active."""
        if len(self._remaining) > 1:
            reached, *rest = self._remaining
            self._remaining = [*rest, reached] if self.options.loop else rest


def _waypoints(params: Params, start: Pose, name: str) -> list[Point]:
    """Return the waypoints in the world [m], from `<waypoints>`, else from `<circle>`, else from `<line>`."""
    kinds = [kind for kind in _KINDS if params.has(kind)]
    if not kinds:
        message = f"plugin {name!r} has no <waypoints>, <circle> or <line>, so it pushes nothing"
        params.warning("SK-PLUGIN-130", message, "add <waypoints><waypoint>2 0</waypoint></waypoints>")
        return []
    if len(kinds) > 1:
        others = " and ".join(f"<{kind}>" for kind in kinds[1:])
        message = f"plugin {name!r} follows <{kinds[0]}>; {others} {'has' if len(kinds) == 2 else 'have'} no effect"
        params.diagnostics.warning("SK-PLUGIN-130", message, params.where, "keep one of the elements")
    waypoints_by_kind = {
        "waypoints": _listed_waypoints(params.block("waypoints"), kinds[0] == "waypoints"),
        "circle": _circle_waypoints(params.block("circle"), start, kinds[0] == "circle"),
        "line": _line_waypoints(params.block("line"), start, kinds[0] == "line"),
    }
    return waypoints_by_kind[kinds[0]]


def _listed_waypoints(block: Params, is_followed: bool) -> list[Point]:
    points = [(x, y) for x, y in (waypoint.vector("waypoint", 2) for waypoint in block.each("waypoint"))]
    if is_followed and not points:
        block.error("SK-PARAM-001", "<waypoints> needs <waypoint>: x and y [m] in the world")
    return points


def _circle_waypoints(block: Params, start: Pose, is_followed: bool) -> list[Point]:
    """Return eight points [m] on a circle around the start pose."""
    radius = block.number("radius", 0.0, required=is_followed, minimum=0.0, maximum=_FARTHEST)
    x, y = start.position[:2].tolist()
    angles = [math.tau * k / _ON_A_CIRCLE for k in range(_ON_A_CIRCLE)]
    return [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]


def _line_waypoints(block: Params, start: Pose, is_followed: bool) -> list[Point]:
    """Return both ends [m] of a line from the start pose; `<direction>` [rad] is relative to the link's x axis."""
    angle = block.number("direction", 0.0, required=is_followed)
    length = block.number("length", 0.0, required=is_followed, minimum=-_FARTHEST, maximum=_FARTHEST)
    far = start.rotate((length * math.cos(angle), length * math.sin(angle), 0.0))
    x, y = start.position[:2].tolist()
    return [(x, y), (x + float(far[0]), y + float(far[1]))]
