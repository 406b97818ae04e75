"""Lidars: planar and with several layers. `lidar` and `ray` see collisions, `gpu_lidar` and `gpu_ray` see visuals."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.compiler.geom_groups import DRAWN_COLLISION, SEEN_AS_COLLISIONS, VISUAL
from simkit.diagnostics import Diagnostics
from simkit.pose import Vector
from simkit.sensors.base import Product, Sensor
from simkit.sensors.noise import Noise, NoiseModel, UniformNoise
from simkit.sensors.point_cloud_messages import LEGACY_CLOUD_TYPE, legacy_point_cloud, point_cloud
from simkit.sensors.rays.lidar_options import MAX_RANGE, LidarOptions, read_options
from simkit.sensors.rays.ray_fan import RayFan, fan_directions
from simkit.sensors.visibility_mask import ALL_VISIBLE, hidden_geoms

if TYPE_CHECKING:
    from simkit.scene import SceneSensor

SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
RANGE = "sensor_msgs/msg/Range"
_BRIGHTEST = 2000.0  # of Gazebo's rendered lidars
_NAMES, _FORMATS = ["x", "y", "z", "intensity", "ring"], ["<f4", "<f4", "<f4", "<f4", "<u2"]
_RING_POINT = np.dtype({"names": _NAMES, "formats": _FORMATS, "offsets": [0, 4, 8, 12, 16], "itemsize": 18})
_WIDE_POINT = np.dtype({"names": _NAMES, "formats": _FORMATS, "offsets": [0, 4, 8, 16, 20], "itemsize": 32})
_POINT = np.dtype([(name, "<f4") for name in ("x", "y", "z", "intensity")])


@dataclass(slots=True)
class LidarReading:
    """What all rays found, layer by layer from the lowest, each array of shape (layers · samples,).

    Attributes:
        ranges: [m].
        intensities: `laser_retro` of what was hit.
        infinite: where the range is no number of metres.
        hits: what was hit, as positions in `geoms`; -1 for nothing.
        geoms: MuJoCo's; the last is -1.
        names: scoped names by geom; the last is empty.
        scatter: what is added to x, y, z [m] and intensity of each ray in a `block` cloud, shape (layers · samples, 4).
    """

    ranges: Vector
    intensities: Vector
    infinite: npt.NDArray[np.bool_]
    hits: npt.NDArray[np.int32]
    geoms: npt.NDArray[np.int32]
    names: npt.NDArray[np.object_]
    scatter: Vector | None = None


class Lidar(Sensor):
    """A fan of rays, all cast at one instant.

    A reading beyond the maximum is +inf. Physics rays start at the minimum range, so that nearer surfaces do not
    exist for them; rendered lidars say -inf for a nearer surface. The sensor's own link is never hit.

    Attributes:
        min_intensity: lowest intensity in messages; of a `velodyne` cloud, of points in it.
        cloud_range: shortest and longest range in a `velodyne` cloud [m], both excluded.
        keeps_order: whether a `velodyne` cloud has a place for every ray.
        radiation: of `Range` messages: 0 ultrasound, 1 infrared.
        field_of_view: of `Range` messages [rad]; None is that of the rays.
        ray_noise: of each ray, besides its own noise.
        range_noise: one draw [m] for all rays of a sample, so of their nearest, besides the noise of each.
        point_noise: of x, y, z [m] and intensity of each ray in a `block` cloud.
    """

    kinds = ("lidar", "ray", "gpu_lidar", "gpu_ray")
    example = "<lidar><range><min>0.1</min><max>10</max></range></lidar>"
    options: LidarOptions
    noise: UniformNoise
    min_intensity = 0.0
    cloud_range = (0.0, math.inf)
    keeps_order = False
    radiation = 1
    field_of_view: float | None = None
    ray_noise: UniformNoise | None = None
    range_noise: Noise | None = None
    point_noise: UniformNoise | None = None

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.options = options = read_options(scene.params)
        self.sees_visuals = scene.kind.startswith("gpu_")
        if not self.sees_visuals and options.visibility_mask != ALL_VISIBLE:
            message = "<visibility_mask> hides nothing from this sensor: collisions have no <visibility_flags>"
            diagnostics.warning("SK-SENSOR-004", message, scene.where, f"a gpu_{scene.kind} sees visuals")
        groups = (DRAWN_COLLISION, VISUAL) if self.sees_visuals else SEEN_AS_COLLISIONS
        grid = options.vertical.angles, options.horizontal.angles
        self._directions = fan_directions(grid[1], grid[0])
        self._fan = RayFan(self._directions, groups, options.range_max, grid=grid)
        self._start = 0.0 if self.sees_visuals else options.range_min
        self._retro: Vector | None = None
        # shared by all readings and messages, which are never written to
        self._dark, self._dark_layer = np.zeros(self._fan.count), np.zeros(options.horizontal.samples, np.float32)
        self._dark.flags.writeable = self._dark_layer.flags.writeable = False
        # as arrays: NumPy takes as long to look at a number as to go through a planar scan
        self._limits = np.array(options.range_min), np.array(options.range_max)

    def describe(self) -> dict[str, Any]:
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
        self.noise = self._make_uniform_noise(self.options.noise, self._fan.count, "ranges")

    @classmethod
    def team_up(cls, sensors: Sequence[Any]) -> None:
        if cls is Lidar:
            from simkit.sensors.rays.lidar_batch import form_lidar_batches

            form_lidar_batches(sensors)

    def products(self) -> dict[str, Product]:
        return {
            "scan": Product(SCAN, self._scan_message),
            "points": Product(CLOUD, self._organised_cloud),
            "hits": Product(CLOUD, self._cloud_of_hits),
            "old_hits": Product(LEGACY_CLOUD_TYPE, self._old_cloud),
            "block": Product(LEGACY_CLOUD_TYPE, self._block_cloud),
            "range": Product(RANGE, self._range_message),
            "velodyne": Product(CLOUD, self._velodyne_cloud),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("scan" if self.sees_visuals else "lidar")
        return {"scan": topic, "points": topic + "/points"}

    def bind(self, compiled: Any) -> None:
        super().bind(compiled)
        names = compiled.names
        link = names.link(self.scene.parent)
        own = link.visuals if self.sees_visuals else link.ray_geoms
        self._is_moved = bool(self._offset_position.any())
        self._is_turned = not np.array_equal(self._offset_rotation, np.eye(3))
        hidden = hidden_geoms(self.options.visibility_mask, names) if self.sees_visuals else []
        self._fan.bind(compiled.model, names, self._body, own, hidden=hidden, offset=self._offset)
        kind = "visuals" if self.sees_visuals else "collisions"
        self._retro = names.shared(f"laser_retro of {kind}", lambda: self._reflectances(compiled))
        self._names = names.shared("scoped names of geoms", lambda: _scoped_names(compiled))

    def _reflectances(self, compiled: Any) -> Vector | None:
        """`laser_retro` by geom id (the last entry, index -1, is for no hit), or None where all are 0."""
        names, found = compiled.names, {}
        for link in names.links.values():
            parts = link.scene.visuals if self.sees_visuals else link.scene.collisions
            values = {part.scoped: part.laser_retro for part in parts if part.laser_retro}
            if values:
                for geom in link.visuals if self.sees_visuals else link.ray_geoms:
                    found[geom] = values.get(names.geom_owner(geom)[1], 0.0)
        if not found:
            return None
        table = np.zeros(compiled.model.ngeom + 1)
        table[list(found)] = list(found.values())
        if self.sees_visuals and self.sim.world.gazebo_quirks:
            np.clip(table, 0.0, _BRIGHTEST, out=table)
        return table

    # ------------------------------------------------------------------ measuring

    @property
    def hits(self) -> npt.NDArray[np.object_] | None:
        """What each ray of the newest sample hit, without noise, or None before the first.

        Scoped names of collisions (of visuals for a rendered lidar), layer by layer from the lowest, shape
        (layers · samples,); empty where nothing is within the range.
        """
        reading: LidarReading | None = self._true_reading()
        if reading is None:
            return None
        geoms = reading.geoms[reading.hits]
        geoms[reading.ranges == np.inf] = -1
        names: npt.NDArray[np.object_] = reading.names[geoms]
        return names

    def measure(self, model: Any, data: Any) -> LidarReading:
        origin, rotation = self._place(data)
        self._fan.cast(model, data, origin, rotation, self._start)
        return self.reading_of_cast()

    def measure_now(self) -> LidarReading:
        """Of the state at this tick."""
        return self.measure(self.sim.mj_model, self._data_now())

    def reading_of_cast(self) -> LidarReading:
        """What the rays found when they were last cast."""
        fan = self._fan
        ranges, infinite = fan.distances, fan.infinite
        if self.sees_visuals and np.minimum.reduce(ranges) < self.options.range_min:
            too_near = ranges < self.options.range_min
            ranges[too_near] = -np.inf
            infinite = infinite | too_near
        return LidarReading(ranges, self._intensities(infinite), infinite, fan.hits, fan.ids, self._names)

    def _place(self, data: Any) -> tuple[Vector, Vector]:
        """The same as `_frame_in_world`, without the arithmetic of an offset that is none."""
        place, turn = data.xpos[self._body], data.xmat[self._body].reshape(3, 3)
        if self._is_moved:
            place = place + turn @ self._offset_position
        return place, turn @ self._offset_rotation if self._is_turned else turn

    def _intensities(self, infinite: npt.NDArray[np.bool_]) -> Vector:
        if self._retro is None:
            return self._dark
        values: Vector = self._retro[self._fan.geoms]
        values[infinite] = 0.0
        return values

    def perturb(self, reading: LidarReading, index: int) -> LidarReading:
        more, shift = self.ray_noise, self.range_noise
        if self.noise.is_silent and more is None and shift is None and self.point_noise is None:
            return reading
        ranges, (low, high) = self.noise.apply(reading.ranges, index), self._limits
        if more is not None:
            ranges = more.apply(ranges, index)
        if shift is not None:
            ranges += shift.apply(np.zeros(1), index)
        np.maximum(ranges, low, out=ranges)
        np.minimum(ranges, high, out=ranges)
        np.copyto(ranges, reading.ranges, where=reading.infinite)
        scatter = None
        if self.point_noise is not None:
            scatter = self.point_noise.apply(np.zeros(4 * self._fan.count), index).reshape(-1, 4)
        r = reading
        return LidarReading(ranges, r.intensities, r.infinite, r.hits, r.geoms, r.names, scatter)

    def add_ray_noise(self, stddev: float) -> None:
        """Sets `ray_noise`, of a standard deviation [m]."""
        self.ray_noise = self._make_uniform_noise(NoiseModel(stddev=stddev), self._fan.count, "more on ranges")

    def add_range_noise(self, stddev: float) -> None:
        """Sets `range_noise`, of a standard deviation [m]."""
        self.range_noise = self._make_noise((NoiseModel(stddev=stddev),), "nearest range")

    def add_point_noise(self, stddev: float) -> None:
        """Sets `point_noise`, of a standard deviation [m, and of intensity]."""
        self.point_noise = self._make_uniform_noise(NoiseModel(stddev=stddev), 4 * self._fan.count, "points")

    # ------------------------------------------------------------------ messages

    def _scan_message(self, reading: LidarReading, time_ns: int) -> Any:
        """All rays of a planar lidar; of several layers the middle one."""
        o, n = self.options, self.options.horizontal.samples
        first = o.vertical.samples // 2 * n
        if self._retro is None and self.min_intensity <= 0:
            intensities = self._dark_layer
        else:
            intensities = reading.intensities[first : first + n].astype(np.float32)
            np.maximum(intensities, self.min_intensity, out=intensities)
        return msgs.type_of(SCAN)(
            msgs.header(time_ns, self.frame_id),
            o.horizontal.low,
            o.horizontal.high,
            o.horizontal.step,
            0.0,
            min(1.0 / self.update_rate, MAX_RANGE) if self.update_rate > 0 else self.sim.timestep,
            o.range_min,
            o.range_max,
            reading.ranges[first : first + n].astype(np.float32),
            intensities,
        )

    def _organised_cloud(self, reading: LidarReading, time_ns: int) -> Any:
        """Every ray, layer by layer from the lowest; rays without a reading are not finite."""
        height, width = self.options.vertical.samples, self.options.horizontal.samples
        points = np.empty(self._fan.count, dtype=_RING_POINT)
        self._fill(points, reading, slice(None))
        points["ring"] = np.repeat(np.arange(height, dtype=np.uint16), width)
        dense = bool(np.isfinite(reading.ranges).all())
        return point_cloud(msgs.header(time_ns, self.frame_id), points, height, width, dense)

    def _cloud_of_hits(self, reading: LidarReading, time_ns: int) -> Any:
        """Only rays with a reading, in one row."""
        hit = np.flatnonzero(np.isfinite(reading.ranges))
        points = np.empty(len(hit), dtype=_POINT)
        self._fill(points, reading, hit)
        return point_cloud(msgs.header(time_ns, self.frame_id), points, 1, len(hit), True)

    def _fill(self, points: Any, reading: LidarReading, which: Any) -> None:
        with np.errstate(invalid="ignore"):
            places = self._directions[which] * reading.ranges[which, None]
        for axis, name in enumerate("xyz"):
            points[name] = places[:, axis]
        points["intensity"] = np.maximum(reading.intensities[which], self.min_intensity)

    def _velodyne_cloud(self, reading: LidarReading, time_ns: int) -> Any:
        """Points within `cloud_range`, layer by layer from the lowest, or every ray, not a number where it has none."""
        height, width = self.options.vertical.samples, self.options.horizontal.samples
        low, high = self.cloud_range
        wanted = (reading.ranges > low) & (reading.ranges < high) & (reading.intensities >= self.min_intensity)
        which = np.arange(self._fan.count) if self.keeps_order else np.flatnonzero(wanted)
        points = np.zeros(len(which), dtype=_WIDE_POINT)
        self._fill(points, reading, which)
        points["ring"] = which // width
        if not self.keeps_order:
            return point_cloud(msgs.header(time_ns, self.frame_id), points, 1, len(points), True)
        for axis in "xyz":
            points[axis][~wanted] = np.nan
        return point_cloud(msgs.header(time_ns, self.frame_id), points, height, width, bool(wanted.all()))

    def _old_cloud(self, reading: LidarReading, time_ns: int) -> Any:
        hit = np.flatnonzero(np.isfinite(reading.ranges))
        places = self._directions[hit] * reading.ranges[hit, None]
        intensities = np.maximum(reading.intensities[hit], self.min_intensity)
        return legacy_point_cloud(msgs.header(time_ns, self.frame_id), places, intensities)

    def _block_cloud(self, reading: LidarReading, time_ns: int) -> Any:
        """Every ray, layer by layer from the lowest; one without a reading ends at the limit that it passed."""
        places = self._directions * np.clip(reading.ranges, *self._limits)[:, None]
        intensities = np.maximum(reading.intensities, self.min_intensity)
        if reading.scatter is not None:
            places[~reading.infinite] += reading.scatter[~reading.infinite, :3]
            intensities = intensities + reading.scatter[:, 3]
        return legacy_point_cloud(msgs.header(time_ns, self.frame_id), places, intensities)

    def _range_message(self, reading: LidarReading, time_ns: int) -> Any:
        """The nearest of all rays."""
        o = self.options
        return msgs.make(
            RANGE,
            header=msgs.header(time_ns, self.frame_id),
            radiation_type=self.radiation,
            field_of_view=self._view_of_rays() if self.field_of_view is None else self.field_of_view,
            min_range=o.range_min,
            max_range=o.range_max,
            range=float(reading.ranges.min()),
        )

    def _view_of_rays(self) -> float:
        o = self.options
        return max(o.horizontal.high - o.horizontal.low, o.vertical.high - o.vertical.low)


def _scoped_names(compiled: Any) -> npt.NDArray[np.object_]:
    """Of the collision or visual that each geom is part of; the last, for no geom, is empty."""
    count = compiled.model.ngeom
    table = np.empty(count + 1, dtype=object)
    table[:] = [*(compiled.names.geom_owner(geom)[1] for geom in range(count)), ""]
    return table
