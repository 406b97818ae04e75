"""Moving obstacles of TurtleBot3's worlds for learning: `libobstacle1.so`, `libobstacle2.so` and `libobstacles.so`.

The times and places are those of `obstacle1`, `obstacle2` and `obstacles` in turtlebot3_simulations, in the branches
foxy-devel to humble for Gazebo Classic (`PoseAnimation`, with its splines) and jazzy for gz (straight lines at constant
speed). One deliberate difference: gz's plugins follow the wall clock, and these follow the simulated time.
"""

from __future__ import annotations

import bisect
import functools
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from simkit import Params, Pose
from simkit.plugins.drives.kinematic_motion import KinematicMotion, KinematicMover, KinematicPlugin, VelocityTarget
from simkit.scene import Trajectory, Waypoint
from simkit_actors.plugins.script import Track

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_WORLD: Final = "world"
_GZ: Final = "turtlebot3_gazebo::"
_SPEED: Final = 0.1  # of gz's obstacles 1 and 2 [m/s]
_HEIGHT: Final = 0.25  # of gz's obstacles 1 and 2 [m]
_CLASSIC_TURN, _GZ_TURN = 40.0, 80.0  # time for one turn of `obstacles` [s]

_CLASSIC_KEYS: Final[dict[str, tuple[tuple[float, float, float], ...]]] = {
    "obstacle1": (
        (0, 0, 0),
        (10, -0.5, -1),
        (50, -3.5, -1),
        (70, -3.7, -3),
        (90, -3.5, -1),
        (130, -0.5, -1),
        (140, 0, 0),
        (160, 0, 0),
    ),
    "obstacle2": (
        (0, 0, 0),
        (10, 0.7, 0.2),
        (40, 2.5, 3.5),
        (55, 0.3, 3.5),
        (85, 3.5, 1.8),
        (100, 3.5, 0),
        (110, 2, 0.5),
        (115, 1.5, 1),
        (120, 1, 0.5),
        (125, 0.5, 0.1),
        (130, 0, 0),
        (140, 0, 0),
    ),
}
"""Time [s], x and y [m] of each key frame; the last one ends the loop."""

_GZ_PLACES: Final[dict[str, tuple[tuple[float, float], ...]]] = {
    "obstacle1": ((2, 2), (1.5, 1), (-1.5, 1), (-1.7, -1), (-1.5, 1), (1.5, 1), (2, 2)),
    "obstacle2": (
        (-2, -2),
        (-1.3, -1.8),
        (0.5, 2),
        (-2, 1.5),
        (1.5, -0.2),
        (1.5, -2),
        (0, -1.5),
        (-0.5, -1),
        (-1, -1.5),
        (-1.5, -1.9),
        (-2, -2),
    ),
}
"""x and y [m] of the waypoints, at a height of 0.25 m."""

_Path = Callable[[float], Pose]
"""Pose in the world at a time [s] after the start."""


@functools.cache
def path_of(library: str, *, is_gz: bool) -> _Path:
    """Return the path of a library such as `obstacle1`, in its version for Gazebo Classic or for gz."""
    if library == "obstacles":
        return _turn_evenly if is_gz else _turn_along_spline
    return _straight_path(_GZ_PLACES[library]) if is_gz else _spline_path(_CLASSIC_KEYS[library])


def _turn_evenly(time: float) -> Pose:
    return Pose.from_rpy(0.0, 0.0, 0.0, 0.0, 0.0, math.tau * math.fmod(time / _GZ_TURN, 1.0))


def _turn_along_spline(time: float) -> Pose:
    """Return the pose on Gazebo's `RotationSpline` through yaw 0, π and 2π."""
    half, t = divmod(math.fmod(time, _CLASSIC_TURN) / (_CLASSIC_TURN / 2), 1.0)
    bend = t * t * (1.0 - t) if half else -t * (1.0 - t) * (1.0 - t)
    return Pose.from_rpy(0.0, 0.0, 0.0, 0.0, 0.0, math.pi * (half + t + bend / 2))


def _spline_path(keys: Sequence[tuple[float, float, float]]) -> _Path:
    waypoints = tuple(Waypoint(t, Pose((x, y, 0.0))) for t, x, y in keys)
    track = Track(Trajectory(0, "", waypoints), Pose())

    def pose(time: float) -> Pose:
        row, part = track.row(math.fmod(time, track.length))
        return Pose(track.poses[row, :3] * (1.0 - part) + track.poses[row + 1, :3] * part)

    return pose


def _straight_path(places: Sequence[tuple[float, float]]) -> _Path:
    times = [0.0]
    for first, second in pairwise(places):
        times.append(times[-1] + math.dist(first, second) / _SPEED)

    def pose(time: float) -> Pose:
        time = math.fmod(time, times[-1])
        i = min(bisect.bisect_right(times, time), len(places) - 1)
        part = (time - times[i - 1]) / (times[i] - times[i - 1])
        x, y = (a + (b - a) * part for a, b in zip(places[i - 1], places[i], strict=True))
        return Pose((x, y, _HEIGHT))

    return pose


class Turtlebot3Obstacle(KinematicPlugin):
    """Moves an obstacle of TurtleBot3's worlds along its path, again and again, from the time at which it was loaded.

    The model goes to the poses of the path in the world, as in Gazebo; a static model is moved, too. It pushes what is
    in its way, and has no contacts with the ground and other static geometry, in which the files place it.
    """

    filenames = ("libobstacle1.so", "libobstacle2.so", "libobstacles.so")
    names = tuple(f"{_GZ}Obstacle{which}Plugin" for which in ("1", "2", "s"))
    drives = False  # of joints: a static model is moved, too

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        record = builder.records[scene.scoped.split("::")[0]]
        for link in scene.all_links():
            body, name = builder.names.link(link.scoped).body_name, f"{link.scoped}#path"
            if not scene.static and body != _WORLD and name not in record.excludes:  # another plugin may move it, too
                builder.spec.add_exclude(name=name, bodyname1=_WORLD, bodyname2=body)
                record.excludes.append(name)

    def load(self, parent: Model, params: Params) -> None:
        source = self.source
        file, name = (source.filename, source.name) if source is not None else ("", "")
        library = next((key for key in _GZ_PLACES if key in file or f"{_GZ}{key.title()}Plugin" == name), "obstacles")
        self._path = library, name.startswith(_GZ)
        self._model, self._start_ns, self._is_placed = parent, self.sim.time_ns, False
        links = [link.scoped for link in parent.scene.all_links()]
        self._mover, self._motion = KinematicMover(self.sim), None
        if not parent.static and links:
            self._motion = KinematicMotion(self.sim, links, links[0])
            self._in_link = self.sim.link(links[0]).pose.inverse() @ parent.pose

    def velocity_targets(self) -> list[VelocityTarget]:
        """Place the model at the start, or a static model at every step; then return its velocity along the path."""
        library, is_gz = self._path
        path, time = path_of(library, is_gz=is_gz), (self.sim.time_ns - self._start_ns) * 1e-9
        if self._motion is None or not self._is_placed:
            self._is_placed = True
            self._model.set_pose(path(time))
        if self._motion is None:
            return []
        frame = self._motion.frame
        way = frame.inverse() @ path(time + self.period) @ self._in_link.inverse()
        w, *turn = way.quaternion.tolist()
        x, y, z = (way.position / self.period).tolist()
        roll, pitch, yaw = (2.0 / self.period * math.copysign(axis, axis * w) for axis in turn)  # of a small turn
        return [VelocityTarget(self._motion, frame, *self.bounded((x, y, z), (roll, pitch, yaw)))]
