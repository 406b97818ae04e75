"""Scans of a lidar that sweeps: what is measured so far, and the reading of all rays."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.pose import Vector
from simkit.runtime.engine.pose_history import PoseRows
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.sweep import RayPattern
from simkit.sensors.rays.sweep_poses import Poses, SweepPoses, rotate


class ScanPart(NamedTuple):
    """Rays of a scan that were cast before the model was modified.

    Attributes:
        numbers: numbers of the rays, shape (k,).
        distances: distances [m], infinite for no hit, shape (k,).
        geoms: geoms of the model of that time; -1 for no hit, shape (k,).
        retro: `laser_retro` of those geoms; None if all are 0.
        names: scoped names by geom id of that model.
    """

    numbers: Ids
    distances: Vector
    geoms: npt.NDArray[np.int32]
    retro: Vector | None
    names: npt.NDArray[np.object_]

    def geoms_in(self, names: npt.NDArray[np.object_]) -> npt.NDArray[np.int32]:
        """Return the geoms in another model, by its names; -1 for objects that are gone."""
        if names is self.names:
            return self.geoms
        first: dict[str, int] = {}
        for geom, name in enumerate(names[:-1].tolist()):
            first.setdefault(name, geom)
        return np.array([first.get(name, -1) for name in self.names[self.geoms].tolist()], dtype=np.int32)


class ScanProgress(NamedTuple):
    """Scan that has begun.

    Attributes:
        pattern: directions and times of the rays.
        done: time after the stamp up to which the rays are cast [s]; negative for none.
        parts: rays that are cast.
    """

    pattern: RayPattern
    done: float = -1.0
    parts: tuple[ScanPart, ...] = ()

    def columns(self, until: float) -> Ids:
        """Return the columns of the pattern that are not cast yet and fire up to a time [s]."""
        times = self.pattern.times
        if self.done < 0 and until == math.inf:
            return np.arange(len(times))
        return np.flatnonzero((times > self.done) & (times <= until))


class EndedScan(NamedTuple):
    """Scan whose last ray has been fired: all that its reading needs besides the physics of the last tick."""

    progress: ScanProgress
    start: int
    poses: PoseRows


class SweptRays:
    """Times and poses of the rays of one reading.

    Attributes:
        pattern: directions in the sensor's frame, and times.
        poses: poses of all bodies during the scan; after a spawn or a removal in mid-scan, since then.

    Args:
        body: body of the sensor; 0 for a static one.
        offset: position [m], shape (3,), and quaternion, shape (4,), of the sensor in the frame of its body.
    """

    def __init__(self, pattern: RayPattern, poses: SweepPoses, body: int, offset: tuple[Vector, Vector]) -> None:
        self.pattern, self.poses = pattern, poses
        self._body, self._offset = body, offset

    @property
    def directions(self) -> Vector:
        """Unit vectors of the rays in the sensor's frame at each ray's own time, shape (n, 3)."""
        return self.pattern.directions

    @property
    def ray_times(self) -> Vector:
        """Time of each ray after the stamp [s], shape (n,)."""
        return self.pattern.ray_times

    def sensor_poses(self) -> Poses:
        """Return the pose of the sensor in the world at the time of each ray; columns, shapes (3, n) and (4, n)."""
        position, quaternion = (part[:, None] for part in self._offset)
        times = self.ray_times
        if not self._body:
            shape = len(times)
            return Poses(np.repeat(position, shape, axis=1), np.repeat(quaternion, shape, axis=1))
        frame = self.poses.at(self._body, times)
        positions = frame.positions + rotate(frame.quaternions, position)
        w, x, y, z = frame.quaternions
        a, b, c, d = quaternion
        turned = np.stack(
            (
                w * a - x * b - y * c - z * d,
                w * b + x * a + y * d - z * c,
                w * c - x * d + y * a + z * b,
                w * d + x * c - y * b + z * a,
            )
        )
        return Poses(positions, turned)

    def body_poses(self, bodies: Ids) -> Poses:
        """Return the pose in the world of one body for each ray, at the ray's time; bodies have the shape (n,)."""
        return self.poses.at(bodies, self.ray_times)
