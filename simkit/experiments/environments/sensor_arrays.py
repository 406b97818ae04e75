"""Lidars and inertial units of all environments of a batch, as arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from mujoco.batch import Batch

from simkit.experiments.environments.array_view import ArrayView, multiply
from simkit.linear_algebra import matmul
from simkit.runtime.engine.random_streams import RandomStream
from simkit.runtime.engine.simulated_time import TickGrid
from simkit.sensors.inertial.imu import Imu
from simkit.sensors.inertial.inertial_kinematics import quaternion_of_rotation_vector
from simkit.sensors.noise import Noise, quantise
from simkit.sensors.rays.embree_rays import TriangleBody
from simkit.sensors.rays.lidar import Lidar
from simkit.sensors.rays.ray_culling import ENDLESS

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]


class NoiseArrays:
    """White noise and constant bias of one sensor in all environments, each with the seed of its own episode."""

    def __init__(self, count: int) -> None:
        self._streams: list[RandomStream | None] = [None] * count
        self._of: list[Noise | None] = [None] * count
        self._numbers: list[tuple[Floats, Floats]] = [(np.zeros(1), np.zeros(1))] * count
        self._precision = np.zeros(1)

    def take(self, row: int, noise: Noise, seed: int) -> None:
        """Copy the noise of the simulation to one environment."""
        white = noise._white
        stream = None if white is None else RandomStream(seed, white.scoped, white.channel, white.width)
        self._streams[row], self._precision = stream, noise._precision
        self._numbers[row] = noise.state.interval.stddev.copy(), np.array(noise.state.constant)

    def apply(self, values: Floats, ids: Ids, index: npt.NDArray[np.int64]) -> None:
        """Add the noise to the rows of some environments, in place."""
        for row in ids.tolist():
            stream, (stddev, constant) = self._streams[row], self._numbers[row]
            if stream is not None:
                values[row] += stream.normal(int(index[row])) * stddev
            if constant.any():
                values[row] += constant
        if self._precision.any():
            values[ids] = quantise(values[ids], self._precision)


class SampleCounter:
    """Numbers of the samples of one sensor in all environments; the noise depends on them."""

    def __init__(self, sensor: Any, count: int) -> None:
        self._sensor, self.index = sensor, np.zeros(count, np.int64)
        self._grid = None if sensor.is_manual else sensor.timetable()

    def take(self, row: int) -> None:
        self.index[row] = self._sensor.count

    def advance(self, ids: Ids, first: int, last: int) -> None:
        """Count the samples at the rate of the sensor, and the sample that an observation takes."""
        if self._sensor.is_manual:
            self.index[ids] += 1
        elif self._grid is None:
            self.index[ids] += last - first
        else:
            due, tick = 0, self._grid.next(first)
            while tick <= last:
                due, is_last, tick = due + 1, tick == last, self._grid.next(tick)
            self.index[ids] += due if due and is_last else due + 1


def sensor_obstacle(sensor: Any) -> str:
    """Return why the samples of a sensor cannot be computed as arrays; empty if they can."""
    if type(sensor) not in (Lidar, Imu):
        return f"sensor {sensor.scoped!r} ({sensor.kind})"
    if sensor.timing.latency > 0 or sensor.timing.jitter or sensor._evolves or sensor._selects_ticks:
        return f"latency, jitter, drifting noise or a battery of sensor {sensor.scoped!r}"
    if not (sensor.is_manual or isinstance(sensor.timetable(), (TickGrid, type(None)))):
        return f"the phase of sensor {sensor.scoped!r}"
    return _lidar_obstacle(sensor) if isinstance(sensor, Lidar) else _imu_obstacle(sensor)


def _lidar_obstacle(sensor: Lidar) -> str:
    fan = sensor._fan
    if sensor.ray_noise is not None or sensor.range_noise is not None:
        return f"noise that a plugin adds to sensor {sensor.scoped!r}"
    targets = fan._targets
    if not fan._by_engine or targets.needs_engine or fan._movers._bodies:
        return f"more than 2047 rays, or rays that may hit moving meshes, of sensor {sensor.scoped!r}"
    return ""


def _imu_obstacle(sensor: Imu) -> str:
    model = sensor.sim.mj_model
    root = int(model.body_weldid[sensor._body])
    joint = int(model.body_jntadr[root])
    is_free = root > 0 and joint >= 0 and int(model.jnt_type[joint]) == 0
    if not is_free or sensor._more_noise is not None:
        return f"sensor {sensor.scoped!r}: its link is not rigidly connected to a free base"
    return ""


class ScanArrays:
    """Ranges of one lidar in all environments.

    Args:
        sensor: lidar of the environment that resets all others.
        view: state of all environments.
        threads: number of threads.
        truth: leave out the noise.
    """

    def __init__(self, sensor: Lidar, view: ArrayView, threads: int, truth: bool) -> None:
        self._sensor, self._view, self._threads, self._truth = sensor, view, threads, truth
        self.counter, self._noise = SampleCounter(sensor, view.count), NoiseArrays(view.count)
        self._casters: list[Any] = [None] * view.count
        self._triangles: list[list[TriangleBody]] = [[]] * view.count
        self._batch: Any = None
        options = sensor.options
        first = options.vertical.samples // 2 * options.horizontal.samples
        self._layer = slice(first, first + options.horizontal.samples)

    def take(self, row: int) -> None:
        """Copy the surroundings and the noise of the sensor to one environment."""
        sensor = self._sensor
        self.counter.take(row)
        self._noise.take(row, sensor.noise, sensor.sim.engine.streams._folded_seed)
        shapes = sensor._fan._targets.shapes_by_engine
        if shapes is not self._casters[row]:
            self._casters[row], self._batch = shapes, None
        self._triangles[row] = sensor._fan._static or []

    def _make_batch(self) -> None:
        """Make the batch of the reduced models, which contain planes and shapes only."""
        fan = self._sensor._fan
        shapes = next((one for one in self._casters if one is not None), None)
        if shapes is None:
            return
        movers = shapes.reachable_movers(fan._carrier, fan.body, fan._offset, *fan._bounds)
        models = [(one or shapes)._all[0] if len(movers) else (one or shapes)._static[0] for one in self._casters]
        self._batch = Batch(models[0], self._view.count, self._threads)
        if any(model is not models[0] for model in models):
            self._batch.set_models(models)
        self._moved = None
        if len(movers):
            kept = shapes._carriers[shapes._firsts] != fan._carrier
            self._moved = self._batch.bind("mocap_pos"), self._batch.bind("mocap_quat"), shapes._bodies, kept

    def read(self, ids: Ids) -> Floats:
        """Return the ranges in all environments, shape (count, samples); only rows of `ids` have noise."""
        if self._batch is None:
            self._make_batch()
        fan, view, sensor = self._sensor._fan, self._view, self._sensor
        shape = (view.count, fan.count, 3)
        positions, turns = view._xpos[:, sensor._body], view._xmat[:, sensor._body].reshape(-1, 3, 3)
        if sensor._is_moved:
            positions = positions + matmul(turns, sensor._offset_position)
        if sensor._is_turned:
            turns = matmul(turns, sensor._offset_rotation)
        positions, directions = (
            np.nan_to_num(positions),
            np.nan_to_num(matmul(fan.directions, turns.transpose(0, 2, 1))),
        )
        distances = np.full(shape[:2], np.inf)
        if self._batch is not None:
            if self._moved is not None:
                places, quaternions, bodies, kept = self._moved
                places[:], quaternions[:] = view._xpos[:, bodies], view._xquat[:, bodies]
                places[:, ~kept] = ENDLESS
            distances = self._cast(positions, directions)
        self._cast_on_triangles(positions, directions, distances)
        infinite = ~(distances <= fan.reach)
        if not self._truth:
            self._noise.apply(distances, ids, self.counter.index)
            np.clip(distances, *sensor._limits, out=distances)
        distances[infinite] = np.inf
        if sensor.sees_visuals:
            distances[distances < sensor.options.range_min] = -np.inf
        return distances[:, self._layer]

    def _cast(self, origins: Floats, directions: Floats) -> Floats:
        start = self._sensor._start
        points = np.broadcast_to(origins[:, None], directions.shape)
        distances: Floats = self._batch.ray(points, directions)[0]
        distances[distances < 0] = np.inf
        if start > 0 and distances.min() < start:
            # the engine has no start distance, so these rays are cast again from there
            near = distances < start
            rows = near.any(axis=1)
            beyond = self._batch.ray(points[rows] + start * directions[rows], directions[rows], ids=rows)[0]
            again = np.where(beyond < 0, np.inf, start + beyond)
            distances[rows] = np.where(near[rows], again, distances[rows])
        return distances

    def _cast_on_triangles(self, origins: Floats, directions: Floats, distances: Floats) -> None:
        """Shorten the distances of rays that hit static triangles, for all environments with the same ones at once."""
        sensor = self._sensor
        kinds = np.array([id(bodies) for bodies in self._triangles])
        for kind in np.unique(kinds).tolist():
            rows = np.flatnonzero(kinds == kind)
            points = np.repeat(origins[rows], sensor._fan.count, axis=0)
            rays, found = directions[rows].reshape(-1, 3), distances[rows].reshape(-1)
            for body in self._triangles[rows[0]]:
                limit = np.minimum(found, sensor._fan.reach, dtype=np.float32)
                hits, lengths, _ = body.cast(sensor.sim.mj_data, points, rays, sensor._start, limit)
                found[hits] = np.minimum(found[hits], lengths)
            distances[rows] = found.reshape(len(rows), -1)


class ImuArrays:
    """Readings of one inertial unit in all environments: orientation, angular velocity, specific force.

    The unit belongs to a free base, whose acceleration the engine computes.
    """

    def __init__(self, sensor: Imu, view: ArrayView, acceleration: Floats, truth: bool) -> None:
        self._sensor, self._view, self._acceleration, self._truth = sensor, view, acceleration, truth
        model = sensor.sim.mj_model
        self._root = int(model.body_weldid[sensor._body])
        self._dof = int(model.jnt_dofadr[model.body_jntadr[self._root]])
        self.counter = SampleCounter(sensor, view.count)
        self._noise, self._turns = NoiseArrays(view.count), NoiseArrays(view.count)
        self._reference, self._gravity = np.zeros((view.count, 4)), np.zeros((view.count, 3))

    def take(self, row: int) -> None:
        """Copy reference, gravity and noise of the sensor to one environment."""
        sensor = self._sensor
        seed = sensor.sim.engine.streams._folded_seed
        self.counter.take(row)
        self._noise.take(row, sensor.noise, seed)
        self._turns.take(row, sensor._attitude_noise, seed)
        self._reference[row], self._gravity[row] = sensor._from_reference, sensor.sim.mj_model.opt.gravity

    def read(self, ids: Ids) -> Floats:
        """Return the readings in all environments, shape (count, 10); only rows of `ids` have noise."""
        sensor, view, root, dof = self._sensor, self._view, self._root, self._dof
        turn = view._xmat[:, root].reshape(-1, 3, 3)
        spin = view._cvel[:, root, :3]
        growth = np.einsum("nij,nj->ni", turn, self._acceleration[:, dof + 3 : dof + 6])
        own = view._xmat[:, sensor._body].reshape(-1, 3, 3)
        arm = view._xpos[:, sensor._body] + matmul(own, sensor._offset_position) - view._xpos[:, root]
        force = self._acceleration[:, dof : dof + 3] - self._gravity
        force = force + np.cross(growth, arm) + np.cross(spin, np.cross(spin, arm))
        axes = matmul(own, sensor._offset_rotation)
        motion = np.hstack((np.einsum("nij,ni->nj", axes, spin), np.einsum("nij,ni->nj", axes, force)))
        attitude = multiply(view._xquat[:, sensor._body], sensor._offset.quaternion)
        attitude = multiply(self._reference, attitude)
        if not self._truth:
            self._noise.apply(motion, ids, self.counter.index)
            if not sensor._attitude_noise.is_silent:
                turns = np.zeros((view.count, 3))
                self._turns.apply(turns, ids, self.counter.index)
                attitude = multiply(attitude, [quaternion_of_rotation_vector(one) for one in turns.tolist()])
        return np.hstack((attitude, motion))
