"""gz's pusher along waypoints: `gz::sim::systems::TrajectoryFollower`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from simkit.params import Params
from simkit.plugins.base import NEVER, ModelPlugin
from simkit.plugins.find_entities import find_named_link, read_topic
from simkit.plugins.one_time_warnings import OneTimeWarnings
from simkit.plugins.options import Options, OptionsOf, block, boolean, number, text, vector
from simkit.plugins.publish_on_demand import set_before_step_rate

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
"""Bearing at which `<zero_vel_on_bearing_reached>` stops the turning."""


class TrajectoryFollowerWaypointsOptions(Options):
    """The `<waypoints>` block."""

    waypoint: tuple[float, ...] = vector(None, size=2)


class TrajectoryFollowerCircleOptions(Options):
    """The `<circle>` block."""

    radius: float = number(0.0, "m", minimum=0.0, maximum=1000000000.0)


class TrajectoryFollowerLineOptions(Options):
    """The `<line>` block."""

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

    While the next waypoint lies farther than `<bearing_tolerance>` from straight ahead (the link's x), the link is
    turned by `<torque>` about its own z; else `<force>` pushes it along its own x, both at the centre of mass. A
    waypoint within `<range_tolerance>` is reached. The last one is kept: a link that is carried away from it comes
    back. `<line>` and `<circle>` count from where the link is at the start. True on
    `/model/<model>/trajectory_follower/pause` pauses, false goes on.

    gz pushes along the axes of `<inertial><pose>`; here it is the link's own, the same unless that pose is turned.
    """

    options = OptionsOf(TrajectoryFollowerOptions)
    filenames = ("gz-sim-trajectory-follower-system",)
    names = ("gz::sim::systems::TrajectoryFollower",)
    drives = True

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, "link_name", params)
        start = next((one.pose_world for one in scene.all_links() if one.scoped == self._scoped), scene.pose_world)
        self._points = _waypoints(params, start, self.name)
        self.options.read_all()

    def load(self, parent: Model, params: Params) -> None:
        self.once = OneTimeWarnings(self)
        self._is_paused, self._is_held = False, False
        self._way = list(self._points)
        self._link = self.sim.link(self._scoped)
        if self.options.zero_vel_on_bearing_reached and not self._link.is_free:
            message = "joints or the world hold the link: <zero_vel_on_bearing_reached> has no effect"
            self.once.warn("SK-PLUGIN-131", "held", message, "name the link that carries the model")
        self._set_pace()
        own = f"/model/{parent.name}/trajectory_follower/pause"
        self.listen(read_topic(params, "topic", own), BOOL, self._on_pause)

    def _on_pause(self, message: Bool) -> None:
        self._is_paused = bool(message.data)
        self._set_pace()

    def _set_pace(self) -> None:
        """Looks at every step unless it is paused, or has nowhere to go."""
        set_before_step_rate(self, NEVER if self._is_paused or not self._way else None)

    def before_step(self) -> None:
        if not self._way or self._is_paused:
            return
        pose, options = self._link.pose, self.options
        (x, y), (goal_x, goal_y) = pose.position[:2].tolist(), self._way[0]
        way = goal_x - x, goal_y - y, 0.0  # heights are left out
        if math.hypot(*way) <= options.range_tolerance:
            self._go_on()
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
            # from straight ahead on, until the bearing leaves the tolerance
            self._is_held = self._is_held or abs(bearing) <= _STRAIGHT
            if self._is_held:
                self._link.set_velocity(self._link.linear_velocity)

    def _go_on(self) -> None:
        """To the next waypoint; the last one stays."""
        if len(self._way) > 1:
            reached, *rest = self._way
            self._way = [*rest, reached] if self.options.loop else rest


def _waypoints(params: Params, start: Pose, name: str) -> list[Point]:
    """The waypoints in the world [m]: those of `<waypoints>`, else of `<circle>`, else of `<line>`."""
    given = [kind for kind in _KINDS if params.has(kind)]
    if not given:
        message = f"plugin {name!r} has no <waypoints>, <circle> or <line>: it pushes nothing"
        params.diagnostics.warning("SK-PLUGIN-130", message, params.where, "<waypoints><waypoint>2 0</waypoint>")
        return []
    if len(given) > 1:
        others = " and ".join(f"<{kind}>" for kind in given[1:])
        message = f"plugin {name!r} follows <{given[0]}>, and not its {others}"
        params.diagnostics.warning("SK-PLUGIN-130", message, params.where, "leave one of them")
    found = {
        "waypoints": _listed_waypoints(params.block("waypoints"), given[0] == "waypoints"),
        "circle": _circle_waypoints(params.block("circle"), start, given[0] == "circle"),
        "line": _line_waypoints(params.block("line"), start, given[0] == "line"),
    }
    return found[given[0]]


def _listed_waypoints(block: Params, is_followed: bool) -> list[Point]:
    found = [(x, y) for x, y in (one.vector("waypoint", 2) for one in block.each("waypoint"))]
    if is_followed and not found:
        block.error("SK-PARAM-001", "<waypoints> needs <waypoint>: x and y [m] in the world")
    return found


def _circle_waypoints(block: Params, start: Pose, is_followed: bool) -> list[Point]:
    """Eight points of a circle about the start."""
    radius = block.number("radius", 0.0, required=is_followed, minimum=0.0, maximum=_FARTHEST)
    x, y = start.position[:2].tolist()
    angles = [math.tau * k / _ON_A_CIRCLE for k in range(_ON_A_CIRCLE)]
    return [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]


def _line_waypoints(block: Params, start: Pose, is_followed: bool) -> list[Point]:
    """The start, and the end of a line from there; its direction [rad] counts from the link's."""
    angle = block.number("direction", 0.0, required=is_followed)
    length = block.number("length", 0.0, required=is_followed, minimum=-_FARTHEST, maximum=_FARTHEST)
    far = start.rotate((length * math.cos(angle), length * math.sin(angle), 0.0))
    x, y = start.position[:2].tolist()
    return [(x, y), (x + float(far[0]), y + float(far[1]))]
