"""Subject of a picture: robots with what they sense and where they went, and the room around them."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.linear_algebra import matmul, norm
from simkit.pose import Pose

if TYPE_CHECKING:
    from simkit.msgs import LaserScan
    from simkit.runtime import Simulation

Points = NDArray[np.float64]

SCANNERS: Final = frozenset({"ray", "gpu_ray", "lidar", "gpu_lidar"})
_CORNERS: Final = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_FLAT: Final = 0.02  # height of a floor, relative to its width
ROOM: Final = 1.8
"""Size of a room that is shown whole, relative to the robots with their scans and paths."""
_LEAST: Final = 1e-3  # [m] size of a subject that is a point


@dataclass(frozen=True)
class Subject:
    """Points that a picture shows [m], each array of shape (n, 3).

    Attributes:
        robots: corners of the boxes around the drawn geoms of all models that are not static.
        centres: middle of each of these boxes.
        traces: points of scans, paths and goals.
        room: corners of the boxes around all other geoms, without floors, if the whole room fits into the picture.
        heading: yaw of the first robot [rad].
    """

    robots: Points
    centres: Points
    traces: Points
    room: Points
    heading: float

    @property
    def points(self) -> Points:
        """All points that must be in the image."""
        return np.concatenate((self.robots, self.traces, self.room))


def find_subject(sim: Simulation, traces: list[Points], room_size: float = ROOM) -> Subject:
    """Return what a picture of a simulation shows.

    Args:
        sim: simulation to show.
        traces: points of scans, paths and goals [m].
        room_size: largest size of a room that is shown whole, relative to the other points.
    """
    moving, fixed = _drawn_geoms(sim)
    boxes = _box_corners(sim, moving)
    seen = np.concatenate([np.zeros((0, 3)), *traces])
    walls = _without_floors(_box_corners(sim, fixed))
    found = np.concatenate((boxes.reshape(-1, 3), seen))
    room = walls.reshape(-1, 3)
    if len(found) and (not len(room) or _size(np.concatenate((found, room))) > room_size * _size(found)):
        room = np.zeros((0, 3))
    if not len(found) and not len(room):
        middle, radius = np.array(sim.mj_model.stat.center), max(float(sim.mj_model.stat.extent) / 4, _LEAST)
        room = middle + radius * _CORNERS
    return Subject(boxes.reshape(-1, 3), boxes.mean(axis=1), seen, room, _heading(sim))


def scan_points(message: LaserScan, pose: Pose) -> Points:
    """Return the points of a `LaserScan` in the world frame [m], shape (n, 3), for a scanner at `pose`."""
    ranges = np.asarray(message.ranges, dtype=np.float64)
    angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
    hit = np.isfinite(ranges)
    flat = np.stack(
        (ranges[hit] * np.cos(angles[hit]), ranges[hit] * np.sin(angles[hit]), np.zeros(int(hit.sum()))), axis=1
    )
    points: Points = matmul(flat, pose.matrix.T) + pose.position
    return points


def last_scans(sim: Simulation) -> dict[str, Points]:
    """Return the points of the newest planar scan of each scanner in the world frame [m], by topic."""
    found: dict[str, Points] = {}
    for sensor in sim.contents.sensors.values():
        if sensor.kind in SCANNERS:
            message = sensor.latest
            if hasattr(message, "ranges"):
                found[sensor.topic] = scan_points(message, sensor.pose)
    return found


def _drawn_geoms(sim: Simulation) -> tuple[list[int], list[int]]:
    """Return the ids of the drawn geoms of models that are not static, and of all others."""
    moving: list[int] = []
    fixed: list[int] = []
    for link in sim.engine.names.links.values():
        model = sim.models.get(link.model)
        is_moving = model is not None and not model.static
        (moving if is_moving else fixed).extend(link.visuals or (link.geoms if is_moving else ()))
    return moving, fixed


def _box_corners(sim: Simulation, geoms: list[int]) -> Points:
    """Return the corners of the boxes around geoms [m], shape (n, 8, 3), without planes."""
    model, data = sim.mj_model, sim.engine.physics.fresh()
    bounded = [geom for geom in geoms if model.geom_rbound[geom] > 0.0]
    drawn = np.array(bounded, dtype=int)
    corners = model.geom_aabb[drawn, None, :3] + _CORNERS * model.geom_aabb[drawn, None, 3:]
    axes = data.geom_xmat[drawn].reshape(-1, 3, 3)
    found: Points = np.einsum("nij,nkj->nki", axes, corners) + data.geom_xpos[drawn, None]
    return found[np.isfinite(found).all(axis=(1, 2))]


def _without_floors(boxes: Points) -> Points:
    """Return boxes without floors: flat boxes that are wider than all other boxes together."""
    if not len(boxes):
        return boxes
    spans = np.ptp(boxes, axis=1)
    widths = np.hypot(spans[:, 0], spans[:, 1])
    is_flat = spans[:, 2] < _FLAT * widths
    solid = boxes[~is_flat]
    if not len(solid):
        return boxes
    span = np.ptp(solid.reshape(-1, 3), axis=0)
    walls: Points = boxes[~is_flat | (widths <= math.hypot(span[0], span[1]))]
    return walls


def _size(points: Points) -> float:
    return max(norm(np.ptp(points, axis=0)), _LEAST)


def _heading(sim: Simulation) -> float:
    """Return the yaw [rad] of the first model that has joints or sensors, else of the first that is not static."""
    moving = [model for model in sim.models.values() if not model.static]
    robots = [model for model in moving if model.joints] or moving
    return float(robots[0].pose.rpy[2]) if robots else 0.0
