"""Lidars: planar and with several layers. `lidar` and `ray` see collisions, `gpu_lidar` and `gpu_ray` see visuals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit import msgs
from simkit.compiler.groups import COLLISION, COLLISION_RAY, DRAWN_COLLISION, VISUAL
from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.base import Product, Sensor
from simkit.sensors.clouds import point_cloud
from simkit.sensors.noise import NoiseModel, UniformNoise, read_noise
from simkit.sensors.rays import RayFan, fan_directions

if TYPE_CHECKING:
    from simkit.scene import SceneSensor

SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
OLD_CLOUD, RANGE = "sensor_msgs/msg/PointCloud", "sensor_msgs/msg/Range"
_NOTHING, _INFINITE = np.array(0.0), np.array(np.inf)
_MOST_RAYS = 4_000_000
_RING_POINT = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "ring"],
        "formats": ["<f4"] * 4 + ["<u2"],
        "offsets": [0, 4, 8, 12, 16],
        "itemsize": 18,
    }
)
_POINT = np.dtype([(name, "<f4") for name in ("x", "y", "z", "intensity")])


@dataclass(frozen=True, slots=True)
class Sweep:
    """`samples` angles from `low` to `high` [rad], both included."""

    samples: int
    low: float
    high: float

    @property
    def step(self) -> float:
        return (self.high - self.low) / (self.samples - 1) if self.samples > 1 else 0.0

    @property
    def angles(self) -> Vector:
        """[rad], shape (samples,)."""
        angles: Vector = self.low + self.step * np.arange(float(self.samples))
        return angles


@dataclass(frozen=True, slots=True)
class LidarOptions:
    """The `<lidar>` or `<ray>` block; ranges in m."""

    horizontal: Sweep
    vertical: Sweep
    range_min: float
    range_max: float
    noise: NoiseModel


@dataclass(frozen=True, slots=True)
class LidarReading:
    """Ranges [m] and intensities of all rays, layer by layer from the lowest, shape (layers · samples,)."""

    ranges: Vector
    intensities: Vector


def read_options(params: Params) -> LidarOptions:
    block = params.child("lidar") or params.block("ray")
    scan, limits = block.block("scan"), block.block("range")
    limits.child("resolution")
    block.child("visualize")
    low = limits.number("min", 0.0, minimum=0)
    high = limits.number("max", 0.0, minimum=0, finite=False)
    if not high > low:
        limits.error("SK-PARAM-002", f"found a range from {low:g} to {high:g} m, allowed is a <max> above <min>")
    horizontal = _read_sweep(scan.block("horizontal"), 640)
    vertical = _read_sweep(scan.block("vertical"), 1)
    if horizontal.samples * vertical.samples > _MOST_RAYS:
        rays = horizontal.samples * vertical.samples
        scan.error("SK-PARAM-002", f"found {rays} rays, allowed are at most {_MOST_RAYS}")
        horizontal = vertical = Sweep(1, 0.0, 0.0)
    _read_mask(block)
    return LidarOptions(horizontal, vertical, low, high, read_noise(block))


def _read_sweep(params: Params, samples: int) -> Sweep:
    resolution = params.number("resolution", 1.0, minimum=0)
    count = params.integer("samples", samples, minimum=1)
    if count > 1 and resolution not in (0.0, 1.0):
        message = f"<resolution>{resolution:g}</resolution>: one ray per sample is cast, as Gazebo does"
        params.diagnostics.note("SK-SENSOR-003", message, params.where)
    low, high = params.number("min_angle", 0.0), params.number("max_angle", 0.0)
    if high < low:
        params.error(
            "SK-PARAM-002", f"found angles from {low:g} to {high:g}, allowed is a <max_angle> of at least <min_angle>"
        )
    return Sweep(count, low, high)


def _read_mask(block: Params) -> None:
    """Only a mask that hides nothing is taken; another one stays unread and so is reported."""
    if block.text("visibility_mask", "4294967295") not in ("4294967295", "-1", "0xffffffff", "0xFFFFFFFF"):
        child = block.child("visibility_mask")
        assert child is not None
        block.diagnostics.warning("SK-SENSOR-004", "<visibility_mask> is not used: everything is seen", child.where)


class Lidar(Sensor):
    """A fan of rays, all cast at one instant.

    A reading beyond the maximum is +inf. Physics rays start at the minimum range, so that nearer surfaces do not
    exist for them; rendered lidars say -inf for a nearer surface. The sensor's own link is never hit.

    Attributes:
        min_intensity: lowest intensity in messages.
        radiation: of `Range` messages: 0 ultrasound, 1 infrared.
    """

    kinds = ("lidar", "ray", "gpu_lidar", "gpu_ray")
    example = "<lidar><range><min>0.1</min><max>10</max></range></lidar>"
    options: LidarOptions
    noise: UniformNoise
    min_intensity = 0.0
    radiation = 1

    def __init__(self, scene: SceneSensor, diagnostics: Diagnostics) -> None:
        super().__init__(scene, diagnostics)
        self.options = options = read_options(scene.params)
        self.sees_visuals = scene.kind.startswith("gpu_")
        groups = (DRAWN_COLLISION, VISUAL) if self.sees_visuals else (COLLISION, COLLISION_RAY, DRAWN_COLLISION)
        self._directions = fan_directions(options.horizontal.angles, options.vertical.angles)
        self._fan = RayFan(self._directions, groups, options.range_max)
        self._retro: Vector | None = None
        self._dark = np.zeros(self._fan.count)  # shared by all readings, which are never written to
        self._dark.flags.writeable = False
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
        self._scan_type = msgs.type_of(SCAN)

    def products(self) -> dict[str, Product]:
        return {
            "scan": Product(SCAN, self._scan_message),
            "points": Product(CLOUD, self._organised_cloud),
            "hits": Product(CLOUD, self._cloud_of_hits),
            "old_hits": Product(OLD_CLOUD, self._old_cloud),
            "range": Product(RANGE, self._range_message),
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("scan" if self.sees_visuals else "lidar")
        return {"scan": topic, "points": topic + "/points"}

    def bind(self, compiled: Any) -> None:
        super().bind(compiled)
        link = compiled.names.link(self.scene.parent)
        own = link.visuals if self.sees_visuals else link.ray_geoms
        self._fan.bind(compiled.model, compiled.names, self._body, own)
        kind = "visuals" if self.sees_visuals else "collisions"
        self._retro = compiled.names.shared(f"laser_retro of {kind}", lambda: self._reflectances(compiled))

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
        return table

    # ------------------------------------------------------------------ measuring

    def measure(self, model: Any, data: Any) -> LidarReading:
        options, fan = self.options, self._fan
        origin, rotation = self._frame_in_world(data)
        fan.cast(model, data, origin, rotation)
        ranges = fan.distances.copy()
        low, high = self._limits
        nothing = ranges < _NOTHING
        nothing |= ranges > high
        np.copyto(ranges, _INFINITE, where=nothing)
        if np.minimum.reduce(ranges) < options.range_min:
            too_near = ranges < low
            if self.sees_visuals:
                ranges[too_near] = -np.inf
            else:
                again = np.flatnonzero(too_near)
                fan.recast(model, data, origin, options.range_min, again)
                found = fan.distances[again]
                ranges[again] = np.where((found < 0) | (found > options.range_max), np.inf, found)
        return LidarReading(ranges, self._intensities(ranges))

    def _intensities(self, ranges: Vector) -> Vector:
        if self._retro is None:
            return self._dark
        values: Vector = np.where(np.isfinite(ranges), self._retro[self._fan.geoms], 0.0)
        return values

    def perturb(self, reading: LidarReading, index: int) -> LidarReading:
        if self.noise.is_silent:
            return reading
        ranges = self.noise.apply(reading.ranges, index)
        infinite, (low, high) = np.isinf(reading.ranges), self._limits
        np.maximum(ranges, low, out=ranges)
        np.minimum(ranges, high, out=ranges)
        np.copyto(ranges, reading.ranges, where=infinite)
        return LidarReading(ranges, reading.intensities)

    # ------------------------------------------------------------------ messages

    def _scan_message(self, reading: LidarReading, time_ns: int) -> Any:
        """All rays of a planar lidar; of several layers the middle one."""
        o, n = self.options, self.options.horizontal.samples
        first = o.vertical.samples // 2 * n
        intensities = reading.intensities[first : first + n].astype(np.float32)
        if self.min_intensity > 0:
            np.maximum(intensities, self.min_intensity, out=intensities)
        return self._scan_type(
            msgs.header(time_ns, self.frame_id),
            o.horizontal.low,
            o.horizontal.high,
            o.horizontal.step,
            0.0,
            1.0 / self.update_rate if self.update_rate > 0 else self.sim.timestep,
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

    def _old_cloud(self, reading: LidarReading, time_ns: int) -> Any:
        hit = np.flatnonzero(np.isfinite(reading.ranges))
        places = self._directions[hit] * reading.ranges[hit, None]
        point = msgs.type_of("geometry_msgs/msg/Point32")
        values = np.maximum(reading.intensities[hit], self.min_intensity).astype(np.float32)
        return msgs.type_of(OLD_CLOUD)(
            msgs.header(time_ns, self.frame_id),
            [point(*place) for place in places.tolist()],
            [msgs.type_of("sensor_msgs/msg/ChannelFloat32")("intensity", values)],
        )

    def _range_message(self, reading: LidarReading, time_ns: int) -> Any:
        """The nearest of all rays."""
        o = self.options
        return msgs.make(
            RANGE,
            header=msgs.header(time_ns, self.frame_id),
            radiation_type=self.radiation,
            field_of_view=max(o.horizontal.high - o.horizontal.low, o.vertical.high - o.vertical.low),
            min_range=o.range_min,
            max_range=o.range_max,
            range=float(reading.ranges.min()),
        )
