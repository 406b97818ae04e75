"""Subject of a picture: robots with what they sense and where they went, and the room around them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from simkit.linear_algebra import matmul, norm
from simkit.pose import Pose
from simkit.recording.pictures.stray_models import find_stray_models
from simkit.runtime.particle_clouds import find_clouds

if TYPE_CHECKING:
    from simkit.msgs import LaserScan
    from simkit.runtime import Simulation

Points = NDArray[np.float64]

SCANNERS: Final = frozenset({"ray", "gpu_ray", "lidar", "gpu_lidar"})
_CORNERS: Final = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_FLAT: Final = 0.02  # height of a floor, relative to its width
ROOM: Final = 1.8
"""Size of a room that is shown whole, relative to the robots with their scans and paths."""
_SCAN_REACH: Final = 3.0
"""Distance up to which scans are in a picture without a room, relative to the size of the robots with their paths."""
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
        room_centres: middle of each box of the room.
        left_out: names of models that fell out of the world or are far away, and that are not framed.
    """

    robots: Points
    centres: Points
    traces: Points
    room: Points
    heading: float
    room_centres: Points = field(default_factory=lambda: np.zeros((0, 3)))
    left_out: tuple[str, ...] = ()

    @property
    def points(self) -> Points:
        """All points that must be in the image."""
        return np.concatenate((self.robots, self.traces, self.room))


def find_subject(
    sim: Simulation,
    traces: Iterable[tuple[str, Points]],
    room_size: float = ROOM,
    scans: Iterable[tuple[str, Points]] = (),
) -> Subject:
    """Return what a picture of a simulation shows.

    Args:
        sim: simulation to show.
        traces: points of paths and goals [m], each with the model that it belongs to, or an empty name; those of models
            that are left out are not framed.
        room_size: largest size of a room that is shown whole, relative to the other points.
        scans: points of scans, like `traces`. Without a room around the robots, those far away are not framed: on open
            ground, rays of 100 m would make a car a dot.
    """
    drawn = _drawn_geoms(sim)
    moving_models = _moving_models(sim)
    moving = [name for name in drawn if name in moving_models]
    boxes_by_model = {name: _box_corners(sim, geoms) for name, geoms in drawn.items()}
    corners = {name: boxes.reshape(-1, 3) for name, boxes in boxes_by_model.items()}
    # a model whose meshes are all missing is at a place too, and has a path
    corners |= {name: sim.models[name].pose.position[None] for name in moving if not len(corners[name])}
    robots = [name for name in moving if _is_robot(sim, name)]
    left_out = find_stray_models(sim, corners, moving, robots, _ground(sim))
    none = np.zeros((0, 8, 3))
    boxes = np.concatenate([none, *(boxes_by_model[name] for name in moving if name not in left_out)])
    fixed = [name for name in drawn if name not in moving and name not in left_out]
    walls = _without_floors(np.concatenate([none, *(boxes_by_model[name] for name in fixed)]))
    nothing = np.zeros((0, 3))
    driven = np.concatenate([nothing, *(points for name, points in traces if name not in left_out)])
    scanned = np.concatenate([nothing, *(points for name, points in scans if name not in left_out)])
    seen = np.concatenate((driven, scanned))
    points = np.concatenate((boxes.reshape(-1, 3), seen))
    room = walls.reshape(-1, 3)
    limit = math.inf if not robots and not len(seen) else room_size  # objects at rest, such as furniture
    if len(boxes) and (not len(room) or _size(np.concatenate((points, room))) > limit * _size(points)):
        room = np.zeros((0, 3))
    nearby = np.concatenate((boxes.reshape(-1, 3), driven))
    if len(nearby) and len(scanned) and not len(room):
        seen = np.concatenate((driven, _within_reach(scanned, nearby)))
    if not len(points) and not len(room):  # smoke alone, or nothing
        room = np.concatenate([np.zeros((0, 3)), *(cloud.positions for cloud in find_clouds(sim, sim.time))])
    if not len(points) and not len(room):
        middle, radius = np.array(sim.mj_model.stat.center), max(float(sim.mj_model.stat.extent) / 4, _LEAST)
        room = middle + radius * _CORNERS
    centres = walls.mean(axis=1)
    return Subject(boxes.reshape(-1, 3), boxes.mean(axis=1), seen, room, _heading(sim), centres, left_out)


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
    points_by_topic: dict[str, Points] = {}
    for sensor in sim.contents.sensors.values():
        if sensor.kind in SCANNERS:
            message = sensor.latest
            if hasattr(message, "ranges"):
                points_by_topic[sensor.topic] = scan_points(message, sensor.pose)
    return points_by_topic


def scan_traces(sim: Simulation, scans: Mapping[str, Points]) -> list[tuple[str, Points]]:
    """Return the points of scans by topic [m], each with the top-level model of its scanner."""
    owners = {sensor.topic: name.split("::", 1)[0] for name, sensor in sim.contents.sensors.items()}
    return [(owners.get(topic, ""), points) for topic, points in scans.items()]


def _drawn_geoms(sim: Simulation) -> dict[str, list[int]]:
    """Return the ids of the drawn geoms of each top-level model; those of its collisions where it has no visuals."""
    moving = _moving_models(sim)
    drawn: dict[str, list[int]] = {}
    for link in sim.engine.names.links.values():
        draws_collisions = link.model in moving or link.has_missing_visuals
        drawn.setdefault(link.model, []).extend(link.visuals or (link.geoms if draws_collisions else ()))
    return drawn


def _moving_models(sim: Simulation) -> set[str]:
    """Return the top-level models that are not static, and do not consist of static models."""
    return {
        link.model
        for link in sim.engine.names.links.values()
        if not link.static and (model := sim.models.get(link.model)) is not None and not model.static
    }


def _is_robot(sim: Simulation, name: str) -> bool:
    """Check whether a model has joints or sensors."""
    scenes = sim.models[name].scene.all_models()
    return any(model.joints or any(link.sensors for link in model.links) for model in scenes)


def _ground(sim: Simulation) -> float:
    """Return the height of the lowest static collision [m], infinite if there is none."""
    model, data = sim.mj_model, sim.engine.physics.fresh()
    static = (model.geom_contype | model.geom_conaffinity != 0) & (model.body_weldid[model.geom_bodyid] == 0)
    chosen = np.flatnonzero(static)
    if not len(chosen):
        return math.inf
    rows = data.geom_xmat[chosen].reshape(-1, 3, 3)[:, 2]  # the vertical axis in the frame of each geom
    depths = (np.abs(rows) * model.geom_aabb[chosen, 3:]).sum(axis=1) - (rows * model.geom_aabb[chosen, :3]).sum(axis=1)
    depths[model.geom_type[chosen] == int(mujoco.mjtGeom.mjGEOM_PLANE)] = 0.0
    return float((data.geom_xpos[chosen, 2] - depths).min())


def _box_corners(sim: Simulation, geoms: list[int]) -> Points:
    """Return the corners of the boxes around geoms [m], shape (n, 8, 3), without planes.

    The box of a mesh has the axes of the world: that of the engine has the principal axes of the mesh. In a building
    of one mesh, these are at an angle to the walls, and the box is up to twice as large.
    """
    model, data = sim.mj_model, sim.engine.physics.fresh()
    bounded = [geom for geom in geoms if model.geom_rbound[geom] > 0.0]
    drawn = np.array(bounded, dtype=int)
    corners = model.geom_aabb[drawn, None, :3] + _CORNERS * model.geom_aabb[drawn, None, 3:]
    axes = data.geom_xmat[drawn].reshape(-1, 3, 3)
    corners_in_world: Points = np.einsum("nij,nkj->nki", axes, corners) + data.geom_xpos[drawn, None]
    for row, geom in enumerate(bounded):
        if model.geom_type[geom] == int(mujoco.mjtGeom.mjGEOM_MESH):
            mesh = model.geom_dataid[geom]
            start = model.mesh_vertadr[mesh]
            vertices = model.mesh_vert[start : start + model.mesh_vertnum[mesh]]
            placed = np.einsum("ij,nj->ni", axes[row], vertices.astype(np.float64)) + data.geom_xpos[geom]
            low, high = placed.min(axis=0), placed.max(axis=0)
            corners_in_world[row] = (low + high) / 2 + _CORNERS * (high - low) / 2
    return corners_in_world[np.isfinite(corners_in_world).all(axis=(1, 2))]


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


def _within_reach(scanned: Points, nearby: Points) -> Points:
    """Return the points of scans [m] that are near robots and paths, compared with the size of these."""
    middle = (nearby.min(axis=0) + nearby.max(axis=0)) / 2
    ways = scanned - middle
    near: Points = scanned[np.einsum("ij,ij->i", ways, ways) <= (_SCAN_REACH * _size(nearby)) ** 2]
    return near


def _size(points: Points) -> float:
    return max(norm(np.ptp(points, axis=0)), _LEAST)


def _heading(sim: Simulation) -> float:
    """Return the yaw [rad] of the first model that has joints or sensors, else of the first that is not static."""
    moving = [model for model in sim.models.values() if not model.static]
    robots = [model for model in moving if model.joints] or moving
    return float(robots[0].pose.rpy[2]) if robots else 0.0
