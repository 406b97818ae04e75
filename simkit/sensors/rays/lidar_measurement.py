"""Measurements of a lidar: options, ray casting, ranges and intensities, and noise."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler import Compiled
from simkit.compiler.geom_groups import DRAWN_COLLISION, SEEN_AS_COLLISIONS, VISUAL
from simkit.diagnostics import Diagnostics
from simkit.linear_algebra import matmul
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import Vector
from simkit.runtime.array_rules import Ids, SensorRule, Ticks
from simkit.runtime.engine.pose_history import PoseRows
from simkit.runtime.particle_clouds import has_sources
from simkit.scene import SceneSensor
from simkit.sensors.base import Sensor
from simkit.sensors.lasting_samples import LastingSample, LastingSamples
from simkit.sensors.noise import Noise, NoiseModel, UniformNoise, read_noise
from simkit.sensors.particle_echoes import find_echoes
from simkit.sensors.rays.ray_fan import RayFan, RayFanRows, fan_directions
from simkit.sensors.rays.ray_probes import HitSurfaces, RayProbes
from simkit.sensors.rays.sweep import (
    RayPattern,
    SweepOptions,
    column_interval,
    last_time,
    make_pattern,
    read_sweep,
)
from simkit.sensors.rays.sweep_poses import SweepPoses
from simkit.sensors.rays.swept_rays import SweptCaster, SweptHits
from simkit.sensors.rays.swept_scan import EndedScan, ScanPart, ScanProgress, SweptRays
from simkit.sensors.sample import Sample
from simkit.sensors.visibility_mask import ALL_VISIBLE, hidden_geoms, read_visibility_mask

if TYPE_CHECKING:
    from simkit import msgs  # noqa: F401 (in the type parameter)
    from simkit.runtime.state_arrays import StateArrays

_MAX_RAYS = 4_000_000
MAX_RANGE = 3e38  # [m]; messages contain 32-bit floats
_MAX_ANGLE = 1e6  # [rad]; beyond it the angles of neighbouring rays are no longer distinct
_BRIGHTEST = 2000.0  # upper limit of intensities of Gazebo's rendered lidars


@dataclass(frozen=True, slots=True)
class AngleRange:
    """Range of `samples` angles from `low` to `high` [rad], both included."""

    samples: int
    low: float
    high: float

    @property
    def step(self) -> float:
        return (self.high - self.low) / (self.samples - 1) if self.samples > 1 else 0.0

    @property
    def angles(self) -> Vector:
        """Angles [rad], shape (samples,)."""
        angles: Vector = self.low + self.step * np.arange(float(self.samples))
        return angles


@dataclass(frozen=True, slots=True)
class LidarOptions:
    """The `<lidar>` or `<ray>` block; ranges in m.

    Attributes:
        visibility_mask: mask of the visible visuals; one of its bits must be in their `<visibility_flags>`.
        sweep: times of the rays; None for a scan at one instant.
    """

    horizontal: AngleRange
    vertical: AngleRange
    range_min: float
    range_max: float
    noise: NoiseModel
    visibility_mask: int = ALL_VISIBLE
    sweep: SweepOptions | None = None


@dataclass(slots=True)
class LidarReading:
    """Readings of all rays, layer by layer from the lowest; each array has the shape (layers · samples,).

    Attributes:
        ranges: distances [m].
        intensities: `laser_retro` of the objects that were hit.
        infinite: True where the range is infinite.
        hits: indices in `geoms` of the objects that were hit; -1 for no hit.
        geoms: MuJoCo's geom ids; the last entry is -1.
        names: scoped names by geom id; the last is empty.
        scatter: noise of x, y, z [m] and intensity of each ray in a `block` cloud, shape (layers · samples, 4).
        surfaces: surfaces that were hit; None if no artefact wants them.
        second: second return of each ray, infinite for none; None for a lidar with one return.
        probed: results of the probes of artefacts by their names.
        sweep: times and poses of the rays; None for a scan at one instant.
    """

    ranges: Vector
    intensities: Vector
    infinite: npt.NDArray[np.bool_]
    hits: npt.NDArray[np.int32]
    geoms: npt.NDArray[np.int32]
    names: npt.NDArray[np.object_]
    scatter: Vector | None = None
    sweep: SweptRays | None = None
    surfaces: HitSurfaces | None = None
    second: LidarReading | None = None
    probed: Mapping[str, Any] | None = None


class LidarMeasurement(Sensor["msgs.LaserScan"]):
    """Base of the lidars: a fan of rays, cast at one instant or in a sweep, with noise, without messages.

    A reading beyond the maximum is +inf. The rays of `lidar` and `ray` start at the minimum range, so that they pass
    through nearer surfaces. Rendered lidars read -inf for a nearer surface. The sensor's own link is never hit.

    Attributes:
        ray_noise: noise of each ray [m] that a plugin adds to the noise of the file.
        range_noise: noise [m] with one draw for all rays of a sample, added to the noise of each ray.
        point_noise: noise of x, y, z [m] and intensity of each ray in a `block` cloud.
        second_noise: noise of each second return [m]; None for a lidar with one return.
        has_second_returns: True if readings have second returns, with messages of their own.
    """

    _names_for_users = ("hits", "ray_times")
    options: LidarOptions
    noise: UniformNoise
    ray_noise: UniformNoise | None = None
    range_noise: Noise | None = None
    point_noise: UniformNoise | None = None
    second_noise: UniformNoise | None = None
    has_second_returns = False
    _probes: RayProbes | None = None
    _ignores_own_model = False

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        options = self.options
        self.sees_visuals = scene.kind.startswith("gpu_")
        if not self.sees_visuals and options.visibility_mask != ALL_VISIBLE:
            message = "<visibility_mask> has no effect: the sensor detects collisions, which have no flags"
            diagnostics.warning("SK-SENSOR-004", message, scene.where, f"gpu_{scene.kind} detects visuals")
        grid = options.vertical.angles, options.horizontal.angles
        self.use_rays(fan_directions(grid[1], grid[0]), grid)
        self._start = 0.0 if self.sees_visuals else options.range_min
        self._retro: Vector | None = None
        if options.sweep is not None:
            self.lasting = LastingSamples()
        self._pattern: tuple[float, RayPattern] | None = None
        self._caster: SweptCaster | None = None
        # arrays, because NumPy needs as long to convert a number as to process a whole planar scan
        self._limits = np.array(options.range_min), np.array(options.range_max)

    def use_rays(self, directions: Vector, grid: tuple[Vector, Vector] | None = None) -> None:
        """Set the rays; called before the sensor is bound.

        Args:
            directions: unit vectors in the sensor's frame, shape (layers · samples, 3).
            grid: elevations and azimuths [rad] if the directions are all their pairs, layer by layer; None for other
                directions, which may be others in each scan.
        """
        groups = (DRAWN_COLLISION, VISUAL) if self.sees_visuals else SEEN_AS_COLLISIONS
        self._directions = directions
        self.fan = RayFan(directions, groups, self.options.range_max, grid=grid)
        # shared by all readings and messages, and therefore read-only
        self._dark = np.zeros(self.fan.count)
        self._dark_layer = np.zeros(self.options.horizontal.samples, np.float32)
        self._dark.flags.writeable = self._dark_layer.flags.writeable = False

    def read_options(self, params: Params) -> LidarOptions:
        block = params.child("lidar") or params.block("ray")
        scan, limits = block.block("scan"), block.block("range")
        limits.child("resolution")
        block.child("visualize")
        low = limits.number("min", 0.0, minimum=0)
        high = limits.number("max", 0.0, minimum=0, finite=False)
        if MAX_RANGE < high < np.inf:
            limits.block("max").error("SK-PARAM-002", f"found {high:g} m; expected at most {MAX_RANGE:g}, or inf")
            low, high = 0.0, 1.0
        if not high > low:
            limits.error("SK-PARAM-002", f"found a range from {low:g} to {high:g} m; expected a <max> above <min>")
        horizontal = _read_angle_range(scan.block("horizontal"), 640)
        vertical = _read_angle_range(scan.block("vertical"), 1)
        if horizontal.samples * vertical.samples > _MAX_RAYS:
            rays = horizontal.samples * vertical.samples
            scan.error("SK-PARAM-002", f"found {counted(rays, 'ray')}; expected at most {_MAX_RAYS}")
            horizontal = vertical = AngleRange(1, 0.0, 0.0)
        noise, mask = read_noise(block, "gaussian"), read_visibility_mask(block)
        fan = horizontal.samples, vertical.samples, horizontal.high - horizontal.low
        sweep = read_sweep(params, block, *fan, self.update_rate)
        return LidarOptions(horizontal, vertical, low, high, noise, mask, sweep)

    def describe(self) -> dict[str, object]:
        o = self.options
        return {
            "lidar": {
                "h_samples": o.horizontal.samples,
                "h_min": o.horizontal.low,
                "h_max": o.horizontal.high,
                "v_samples": o.vertical.samples,
                "v_min": o.vertical.low,
                "v_max": o.vertical.high,
                "range_min": o.range_min,
                "range_max": o.range_max if math.isfinite(o.range_max) else "inf",
            }
        }

    def prepare(self) -> None:
        self.noise = self._make_uniform_noise(self.options.noise, self.fan.count, "ranges")

    def bind(self, compiled: Compiled) -> None:
        super().bind(compiled)
        names = compiled.names
        link = names.link(self.scene.parent)
        link_geoms = link.visuals if self.sees_visuals else link.ray_geoms
        self._is_moved = bool(self._offset_position.any())
        self._is_turned = not np.array_equal(self._offset_rotation, np.eye(3))
        hidden = hidden_geoms(self.options.visibility_mask, names) if self.sees_visuals else []
        if self._ignores_own_model:
            model = self.scene.parent.split("::")[0] + "::"
            links = [part for scoped, part in names.links.items() if scoped.startswith(model)]
            hidden += [geom for part in links for geom in (part.visuals if self.sees_visuals else part.ray_geoms)]
        self.fan.bind(compiled.model, names, self._body, link_geoms, hidden=hidden, offset=self._offset)
        if self._probes is not None:

            def bind_fan(fan: RayFan, seen_through: Sequence[int]) -> None:
                unseen = [*hidden, *seen_through]
                fan.bind(compiled.model, names, self._body, link_geoms, hidden=unseen, offset=self._offset)

            offset = self._offset_position, self._offset_rotation
            self._probes.bind(compiled, bind_fan, None if self.lasting is None else offset)
        kind = "visuals" if self.sees_visuals else "collisions"
        self._retro = names.shared(f"laser_retro of {kind}", lambda: self._reflectances(compiled))
        self._names = names.shared("scoped names of geoms", lambda: _scoped_names(compiled))
        if self.lasting is not None:
            self._caster = SweptCaster(self.fan, (self._offset_position, self._offset_rotation))
            self._record_poses()

    @property
    def probes(self) -> RayProbes:
        """Further measurements of the rays; artefacts add theirs in `prepare`."""
        if self._probes is None:
            self._probes = RayProbes(self.fan, self.sees_visuals, self._start)
        return self._probes

    def add_second_returns(self) -> None:
        """Give the second returns the noise of the file, with random numbers of their own."""
        self.second_noise = self._make_uniform_noise(self.options.noise, self.fan.count, "second ranges")

    def retro_of(self, geoms: npt.NDArray[np.int32]) -> Vector:
        """Return `laser_retro` by geoms of the compiled model; 0 for -1."""
        return np.zeros(len(geoms)) if self._retro is None else self._retro[geoms]

    def ignore_own_model(self) -> None:
        """Let the rays pass through all links of the sensor's model, as real sensors look out of their housing."""
        self._ignores_own_model = True
        self.batch = None  # the sensor samples alone until the batches are formed again
        self.bind(self.sim.engine.compiled)

    def _reflectances(self, compiled: Compiled) -> Vector | None:
        """Return `laser_retro` by geom id (the last entry, index -1, means no hit), or None if all are 0."""
        names, retro_by_geom = compiled.names, {}
        for link in names.links.values():
            shapes = link.scene.visuals if self.sees_visuals else link.scene.collisions
            values = {shape.scoped: shape.laser_retro for shape in shapes if shape.laser_retro}
            if values:
                for geom in link.visuals if self.sees_visuals else link.ray_geoms:
                    retro_by_geom[geom] = values.get(names.geom_owner(geom)[1], 0.0)
        if not retro_by_geom:
            return None
        table = np.zeros(compiled.model.ngeom + 1)
        table[list(retro_by_geom)] = list(retro_by_geom.values())
        if self.sees_visuals and self.sim.world.gazebo_quirks:
            np.clip(table, 0.0, _BRIGHTEST, out=table)
        return table

    # ------------------------------------------------------------------ measuring

    @property
    def hits(self) -> npt.NDArray[np.object_] | Any:
        """Objects that the rays of the newest sample hit, without noise, or None before the first.

        The names are scoped names of collisions (of visuals for a rendered lidar), layer by layer from the lowest,
        shape (layers · samples,). A name is empty if the ray hits nothing within the range.
        """
        reading: LidarReading | None = self._true_reading()
        if reading is None:
            return None
        geoms = reading.geoms[reading.hits]
        geoms[reading.ranges == np.inf] = -1
        names: npt.NDArray[np.object_] = reading.names[geoms]
        return names

    def ray_ends(self) -> Vector | None:
        """Return the ends of the rays of the newest sample in the sensor's frame [m], shape (layers · samples, 3).

        They have the sensor's noise. A ray without a range is NaN. None before the first sample.
        """
        sample = self._finished_sample()
        if sample is None:
            return None
        reading: LidarReading = sample.noisy
        ranges = np.where(np.isfinite(reading.ranges), reading.ranges, np.nan)
        ends: Vector = self.directions_of(reading) * ranges[:, None]
        return ends

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> LidarReading:
        origin, rotation = self.ray_frame(data)
        self.fan.cast(model, data, origin, rotation, self._start)
        return self._with_echoes(self.reading_of_cast(), data, origin, rotation)

    def _with_echoes(
        self, reading: LidarReading, data: mujoco.MjData, origin: Vector, rotation: Vector
    ) -> LidarReading:
        """Shorten the ranges of rays that particles reflect, in the reading, and return it."""
        if self.sees_visuals and has_sources(self.sim):
            echoes = find_echoes(self.sim, self.scoped, float(data.time), origin, rotation)
            if echoes is not None:
                directions = self._directions if reading.sweep is None else reading.sweep.directions
                reading.ranges = echoes.shorten(directions, reading.ranges)
                reading.infinite = np.isinf(reading.ranges)
        if self._probes is not None:
            reading.surfaces, reading.probed = self._probes.measure(data, origin, rotation, reading.sweep)
        return reading

    def measure_now(self) -> LidarReading:
        """Measure the state at this tick."""
        return self.measure(self.sim.mj_model, self.computed_data())

    def reading_of_cast(self) -> LidarReading:
        """Return the reading of the last cast."""
        fan = self.fan
        ranges, infinite = fan.distances, self._mark_too_near(fan.distances, fan.infinite)
        return LidarReading(ranges, self._intensities(infinite), infinite, fan.hits, fan.ids, self._names)

    def _mark_too_near(self, ranges: Vector, infinite: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
        """Set too short ranges of a rendered lidar to -inf, and return which ranges are infinite; any shape."""
        if self.sees_visuals and np.minimum.reduce(ranges, axis=None) < self.options.range_min:
            too_near = ranges < self.options.range_min
            ranges[too_near] = -np.inf
            infinite = infinite | too_near
        return infinite

    def directions_of(self, reading: LidarReading) -> Vector:
        """Return the directions of the rays in the sensor's frame, shape (layers · samples, 3)."""
        return self._directions if reading.sweep is None else reading.sweep.directions

    # ------------------------------------------------------------------ sweep

    def ray_pattern(self, index: int) -> RayPattern:
        """Return the directions and times of the rays of a sample.

        Only lidars with a `<sweep>` use it. A class or an artefact may replace it, for a scan with another pattern.
        """
        if self._pattern is None or self._pattern[0] != self.update_rate:
            assert self.options.sweep is not None
            columns, rate = self._columns_and_angle(), self.update_rate
            self._pattern = rate, make_pattern(self.options.sweep, self._directions, *columns, rate)
        return self._pattern[1]

    def _columns_and_angle(self) -> tuple[int, float]:
        horizontal = self.options.horizontal
        return horizontal.samples, horizontal.high - horizontal.low

    @property
    def ray_times(self) -> Vector | Any:
        """Time of each ray after the stamp of the next scan [s], shape (layers · samples,); None without a sweep."""
        return None if self.lasting is None else self.ray_pattern(self._index + 1).ray_times

    @property
    def time_increment(self) -> float:
        """Time between two neighbouring columns [s], as messages have it; 0 for a scan at one instant."""
        sweep = self.options.sweep
        return 0.0 if sweep is None else column_interval(sweep, *self._columns_and_angle(), self.update_rate)

    def _apply_rate(self, rate: float) -> None:
        super()._apply_rate(rate)
        if self.lasting is not None:
            self._record_poses()

    def rate_problem(self, rate: float) -> str:
        sweep = self.options.sweep
        if sweep is None:
            return ""
        if not rate > 0:
            return "a lidar that sweeps needs a rate above 0 Hz"
        length = last_time(sweep, *self._columns_and_angle(), rate)
        return f"its scan takes {length:g} s" if length * rate > 1 + 1e-9 else ""

    def _record_poses(self) -> None:
        """Let the physics record the poses of the bodies during a scan."""
        if self._caster is not None and self._caster.needs_poses:
            ticks = self.measurement_ticks(self._index + 1)
            ticks = max(
                [ticks, *(sample.end - sample.start for sample in self.lasting.samples)] if self.lasting else [0]
            )
            self.sim.engine.physics.record_poses(self, ticks + 1)

    def leave(self) -> None:
        super().leave()
        if self.lasting is not None:
            self.sim.engine.physics.end_record_of_poses(self)

    def measurement_ticks(self, index: int) -> int:
        times = self.ray_pattern(index).times
        return math.ceil(float(times.max()) / self.sim.timestep - 1e-6) if len(times) else 0

    def begin_measurement(self, index: int, tick: int) -> ScanProgress:
        return ScanProgress(self.ray_pattern(index))

    def _poses_since(self, start: int, tick: int, data: mujoco.MjData) -> PoseRows:
        history = self.sim.engine.physics.poses
        if history is None or not (self._caster is not None and self._caster.needs_poses):
            return PoseRows(tick, (data.xpos.tobytes(),), (data.xquat.tobytes(),))
        return history.rows(start, tick, data)

    def continue_measurement(self, sample: LastingSample, tick: int) -> ScanProgress:
        progress: ScanProgress = sample.progress
        until = (tick - sample.start) * self.sim.timestep * (1 + 1e-12)
        columns = progress.columns(until)
        if not len(columns) or self._caster is None:
            return progress
        data, hits = self.computed_data(), SweptHits.of(len(progress.pattern.directions))
        poses = SweepPoses(self._poses_since(sample.start, tick, data), sample.start, self.sim.timestep)
        rays = self._caster.world_rays(progress.pattern, poses, columns)
        self._caster.cast(data, rays, self._start, hits)
        numbers = rays.numbers.ravel()
        part = ScanPart(numbers, hits.distances[numbers], hits.geoms[numbers], self._retro, self._names)
        return ScanProgress(progress.pattern, until, (*progress.parts, part))

    def end_measurement(self, sample: LastingSample, tick: int) -> EndedScan:
        poses = self._poses_since(sample.start, tick, self.computed_data())
        return EndedScan(sample.progress, sample.start, poses)

    def capture_held(self, model: mujoco.MjModel, data: mujoco.MjData, sample: Sample) -> LidarReading:
        scan: EndedScan | None = sample.surroundings
        if scan is None or self._caster is None:
            return self.measure(model, data)
        progress, fan = scan.progress, self.fan
        poses = SweepPoses(scan.poses, scan.start, self.sim.timestep)
        hits = SweptHits.of(len(progress.pattern.directions))
        columns = progress.columns(math.inf)
        if len(columns):
            rays = self._caster.world_rays(progress.pattern, poses, columns)
            self._caster.cast(data, rays, self._start, hits)
        for part in progress.parts:
            hits.distances[part.numbers], hits.geoms[part.numbers] = part.distances, part.geoms_in(self._names)
        fan.use(hits.distances, hits.geoms)
        reading = self.reading_of_cast()
        for part in progress.parts:
            if part.names is not self._names and (part.retro is not None or self._retro is not None):
                reading.intensities = np.array(reading.intensities)
                found = 0.0 if part.retro is None else part.retro[part.geoms]
                reading.intensities[part.numbers] = np.where(reading.infinite[part.numbers], 0.0, found)
        reading.sweep = SweptRays(
            progress.pattern, poses, self.fan.body, (self._offset.position, self._offset.quaternion)
        )
        return self._with_echoes(reading, data, *self.ray_frame(data))

    def _limit(self, ranges: Vector, exact: Vector, infinite: npt.NDArray[np.bool_]) -> None:
        """Limit ranges with noise in place; infinite ranges have no noise. The arrays have any shape."""
        low, high = self._limits
        np.maximum(ranges, low, out=ranges)
        np.minimum(ranges, high, out=ranges)
        np.copyto(ranges, exact, where=infinite)

    def ray_frame(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """Return position and rotation matrix in the world, like `_frame_in_world` but faster for an offset of zero."""
        return self._place_fan(data.xpos[self._body], data.xmat[self._body].reshape(3, 3))

    def _place_fan(self, position: Vector, rotation: Vector) -> tuple[Vector, Vector]:
        """Return position and rotation matrix of the fan for those of the body; the first axes may be simulations."""
        if self._is_moved:
            position = position + matmul(rotation, self._offset_position)
        return position, matmul(rotation, self._offset_rotation) if self._is_turned else rotation

    def _intensities(self, infinite: npt.NDArray[np.bool_]) -> Vector:
        if self._retro is None:
            return self._dark
        values: Vector = self._retro[self.fan.geoms]
        values[infinite] = 0.0
        return values

    def perturb(self, reading: LidarReading, index: int) -> LidarReading:
        ray_noise, range_noise = self.ray_noise, self.range_noise
        if self.noise.is_silent and ray_noise is None and range_noise is None and self.point_noise is None:
            return reading
        ranges = self.noise.apply(reading.ranges, index)
        if ray_noise is not None:
            ranges = ray_noise.apply(ranges, index)
        if range_noise is not None:
            ranges += range_noise.apply(np.zeros(1), index)
        self._limit(ranges, reading.ranges, reading.infinite)
        scatter = None
        if self.point_noise is not None:
            scatter = self.point_noise.apply(np.zeros(4 * self.fan.count), index).reshape(-1, 4)
        second = reading.second
        if second is not None and self.second_noise is not None:
            second_ranges = self.second_noise.apply(second.ranges, index)
            self._limit(second_ranges, second.ranges, second.infinite)
            second = replace(second, ranges=second_ranges)
        r = reading
        fixed = r.intensities, r.infinite, r.hits, r.geoms, r.names
        return LidarReading(ranges, *fixed, scatter, r.sweep, r.surfaces, second, r.probed)

    def add_ray_noise(self, stddev: float) -> None:
        """Set `ray_noise` with a standard deviation [m]."""
        self._make_pending_messages()
        self.ray_noise = self._make_uniform_noise(NoiseModel(stddev=stddev), self.fan.count, "more on ranges")

    def add_range_noise(self, stddev: float) -> None:
        """Set `range_noise` with a standard deviation [m]."""
        self._make_pending_messages()
        self.range_noise = self._make_noise((NoiseModel(stddev=stddev),), "nearest range")

    def add_point_noise(self, stddev: float) -> None:
        """Set `point_noise` with a standard deviation, in m for positions and in the unit of intensity."""
        self._make_pending_messages()
        self.point_noise = self._make_uniform_noise(NoiseModel(stddev=stddev), 4 * self.fan.count, "points")


class LidarRule(SensorRule):
    """Ranges of a lidar's scan in n simulations, within the range limits.

    Args:
        lidar: lidar of the simulation that resets all others; its first message is a scan, and `casts_in_rows` is true
            for its fan.
    """

    inputs = ("xpos", "xmat", "xquat")

    def __init__(self, lidar: LidarMeasurement) -> None:
        self._lidar = lidar

    def bind(self, states: StateArrays, *, is_truth: bool) -> None:
        self._positions, self._turns = states.field("xpos"), states.field("xmat")
        self.fan = RayFanRows(self._lidar.fan, states)
        self._noise = None if is_truth else self._lidar.noise.rows(states.count)

    def take(self, row: int) -> None:
        self.fan.take(row)
        if self._noise is not None:
            self._noise.take(row)

    def read(self, ids: Ids, index: Ticks) -> npt.NDArray[np.float32]:
        lidar, body, options = self._lidar, self._lidar._body, self._lidar.options
        frames = lidar._place_fan(self._positions[:, body], self._turns[:, body].reshape(-1, 3, 3))
        ranges = self.fan.cast(*frames, lidar._start)
        infinite = lidar._mark_too_near(ranges, np.isinf(ranges))
        if self._noise is not None:
            exact = ranges.copy()
            self._noise.apply(ranges, ids, index)
            lidar._limit(ranges, exact, infinite)
        width = options.horizontal.samples
        first = options.vertical.samples // 2 * width  # the middle layer is that of the scan
        layer = ranges[:, first : first + width].astype(np.float32)
        return np.clip(layer, float(options.range_min), float(options.range_max))


def _read_angle_range(params: Params, samples: int) -> AngleRange:
    resolution = params.number("resolution", 1.0, minimum=0)
    count = params.integer("samples", samples, minimum=1)
    if count > 1 and resolution not in (0.0, 1.0):
        message = f"<resolution>{resolution:g}</resolution> is ignored: one ray per sample is cast, as in Gazebo"
        params.diagnostics.note("SK-SENSOR-003", message, params.where)
    low = params.number("min_angle", 0.0, minimum=-_MAX_ANGLE, maximum=_MAX_ANGLE)
    high = params.number("max_angle", 0.0, minimum=-_MAX_ANGLE, maximum=_MAX_ANGLE)
    if high < low:
        text = f"found angles from {low:g} to {high:g}; expected a <max_angle> of at least <min_angle>"
        params.warning("SK-PARAM-008", f"{text}; the two are exchanged")
        low, high = high, low
    return AngleRange(count, low, high)


def _scoped_names(compiled: Compiled) -> npt.NDArray[np.object_]:
    """Return the scoped name of each geom's collision or visual; the last entry, for no geom, is empty."""
    count = compiled.model.ngeom
    table = np.empty(count + 1, dtype=object)
    table[:] = [*(compiled.names.geom_owner(geom)[1] for geom in range(count)), ""]
    return table
