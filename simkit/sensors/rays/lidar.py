"""Lidars with one or several layers: `lidar` and `ray` detect collisions, `gpu_lidar` and `gpu_ray` visuals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.msgs.cdr_template import CdrTemplate
from simkit.runtime.array_rules import CannotBatchError, SensorRule
from simkit.runtime.particle_clouds import has_sources
from simkit.sensors.base import Product
from simkit.sensors.measured_rows import MeasuredRows
from simkit.sensors.point_cloud_messages import LEGACY_CLOUD_TYPE, legacy_point_cloud, point_cloud
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.lidar_batch import LidarBatch, lidar_batch_key
from simkit.sensors.rays.lidar_measurement import MAX_RANGE, LidarMeasurement, LidarReading, LidarRule
from simkit.sensors.sensor_batch import form_batches

ECHOES = "sensor_msgs/msg/MultiEchoLaserScan"
SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
RANGE = "sensor_msgs/msg/Range"
_NAMES, _FORMATS = ["x", "y", "z", "intensity", "ring"], ["<f4", "<f4", "<f4", "<f4", "<u2"]
_RING_POINT = np.dtype({"names": _NAMES, "formats": _FORMATS, "offsets": [0, 4, 8, 12, 16], "itemsize": 18})
_WIDE_POINT = np.dtype({"names": _NAMES, "formats": _FORMATS, "offsets": [0, 4, 8, 16, 20], "itemsize": 32})
_MOST_PACKED_RAYS = 1024  # above it, copies of the memory take longer than a scan at its time
_NS = 1_000_000_000
_VARIABLE_FIELDS = ("header.stamp.sec", "header.stamp.nanosec", "ranges")
_POINT = np.dtype([(name, "<f4") for name in ("x", "y", "z", "intensity")])


class Lidar(LidarMeasurement):
    """Lidar with a fan of rays, and its messages: scans, clouds and ranges.

    Attributes:
        min_intensity: lowest intensity in messages; in a `velodyne` cloud, points below it are omitted.
        cloud_range: shortest and longest range in a `velodyne` cloud [m], both excluded.
        keeps_order: True if a `velodyne` cloud has a point for every ray.
        radiation: radiation type of `Range` messages: 0 ultrasound, 1 infrared.
        field_of_view: field of view of `Range` messages [rad]; None uses the angle between the outer rays.
        replaced_products: messages in other forms than those of the kind, such as the cloud of a driver.
    """

    kinds = ("lidar", "ray", "gpu_lidar", "gpu_ray")
    artefact_families = ("lidar",)
    example = "<lidar><range><min>0.1</min><max>10</max></range></lidar>"
    min_intensity = 0.0
    cloud_range = (0.0, math.inf)
    keeps_order = False
    radiation = 1
    field_of_view: float | None = None
    _template_of: object = None
    replaced_products: Mapping[str, Product] = MappingProxyType({})

    @classmethod
    def make_batches(cls, sensors: Sequence[LidarMeasurement]) -> None:
        if cls is Lidar:
            form_batches(sensors, LidarBatch, lidar_batch_key)

    def array_rule(self) -> SensorRule:
        """Return the array rule.

        More than 2047 rays, rays that may hit moving meshes, clouds and ranges are measured one after another.

        Raises:
            CannotBatchError: plugins add noise to the lidar, or particles are in front of it.
        """
        if self.ray_noise is not None or self.range_noise is not None:
            raise CannotBatchError(f"noise that a plugin adds to sensor {self.scoped!r}")
        if self.sees_visuals and has_sources(self.sim):
            raise CannotBatchError(f"particles in front of sensor {self.scoped!r}")
        is_scan = next(iter(self.topics)) == "scan"
        return LidarRule(self) if is_scan and self.fan.casts_in_rows else MeasuredRows(self, casts=True)

    def products(self) -> dict[str, Product]:
        return {
            "scan": Product(SCAN, self._scan_message),
            "points": Product(CLOUD, self._organised_cloud),
            "hits": Product(CLOUD, self._cloud_of_hits),
            "old_hits": Product(LEGACY_CLOUD_TYPE, self._old_cloud),
            "block": Product(LEGACY_CLOUD_TYPE, self._block_cloud),
            "range": Product(RANGE, self._range_message),
            "velodyne": Product(CLOUD, self._velodyne_cloud),
            "second_points": Product(CLOUD, self._cloud_of_second_returns),
            "echoes": Product(ECHOES, self._echo_message),
            **self.replaced_products,
        }

    def default_topics(self) -> dict[str, str]:
        topic = self._default_topic("scan" if self.sees_visuals else "lidar")
        topics = {"scan": topic, "points": topic + "/points"}
        if self.has_second_returns:
            topics |= {"second_points": topic + "/points2", "echoes": topic + "/echoes"}
        return topics

    # ------------------------------------------------------------------ messages

    def packs(self, product: str) -> bool:
        is_streamed = all(publisher.is_only_streamed for _, publisher, _ in self._publishers if publisher.wanted)
        return product == "scan" and self.fan.count <= _MOST_PACKED_RAYS and is_streamed

    def pack_samples(self, first: int, times: Sequence[int], captures: Sequence[LidarReading]) -> Sequence[bytes]:
        o = self.options
        is_changed = type(self)._scan_message is not Lidar._scan_message or "scan" in self.replaced_products
        has_more_noise = self.ray_noise is not None or self.range_noise is not None
        has_intensities = self._retro is not None or self.min_intensity > 0
        if is_changed or has_more_noise or has_intensities or o.sweep is not None or self.noise.evolves:
            return ()
        ranges = np.stack([capture.ranges for capture in captures])
        if not self.noise.is_silent:
            exact, ranges = ranges, self.noise.apply_to_samples(ranges, first)
            self._limit(ranges, exact, np.stack([capture.infinite for capture in captures]))
        seconds, nanoseconds = np.divmod(np.array(times), _NS)
        layer = o.vertical.samples // 2 * o.horizontal.samples
        columns = seconds, nanoseconds, ranges[:, layer : layer + o.horizontal.samples]
        return self._template(captures[0]).fill(len(times), dict(zip(_VARIABLE_FIELDS, columns, strict=True)))

    def _template(self, reading: LidarReading) -> CdrTemplate:
        """Return the serialised scan whose numbers are replaced; it changes with the rate and the frame."""
        constants = self.frame_id, self.update_rate, self.time_increment
        if self._template_of != constants:
            self._stored_template = CdrTemplate(self._scan_message(reading, 0), _VARIABLE_FIELDS)
            self._template_of = constants
        return self._stored_template

    def _scan_message(self, reading: LidarReading, time_ns: int) -> msgs.LaserScan:
        """Make a scan of all rays, or of the middle layer if there are several layers."""
        o, n = self.options, self.options.horizontal.samples
        first = o.vertical.samples // 2 * n
        low, high, step = o.horizontal.low, o.horizontal.high, o.horizontal.step
        ranges = reading.ranges[first : first + n]
        is_clockwise = o.sweep is not None and o.sweep.is_clockwise
        if is_clockwise:  # the first ray of the message is the first one in time
            low, high, step, ranges = high, low, -step, ranges[::-1]
        if self._retro is None and self.min_intensity <= 0 and not self.artefacts:
            intensities = self._dark_layer
        else:
            intensities = reading.intensities[first : first + n].astype(np.float32)
            np.maximum(intensities, self.min_intensity, out=intensities)
            if is_clockwise:
                intensities = np.ascontiguousarray(intensities[::-1])
        message: msgs.LaserScan = msgs.type_of(SCAN)(
            msgs.header(time_ns, self.frame_id),
            low,
            high,
            step,
            self.time_increment,
            min(1.0 / self.update_rate, MAX_RANGE) if self.update_rate > 0 else self.sim.timestep,
            o.range_min,
            o.range_max,
            ranges.astype(np.float32),
            intensities,
        )
        return message

    def _organised_cloud(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud2:
        """Make a cloud of all rays, layer by layer from the lowest; rays without a reading are not finite."""
        height, width = self.options.vertical.samples, self.options.horizontal.samples
        points = self._points(reading, slice(None), _RING_POINT)
        points["ring"] = np.repeat(np.arange(height, dtype=np.uint16), width)
        dense = bool(np.isfinite(reading.ranges).all())
        return point_cloud(msgs.header(time_ns, self.frame_id), points, height, width, dense)

    def _cloud_of_second_returns(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud2:
        """Make a cloud of the second returns of all rays, as the driver of Ouster does; empty in the ground truth."""
        if reading.second is None:
            return point_cloud(msgs.header(time_ns, self.frame_id), np.zeros(0, _RING_POINT), 1, 0, True)
        return self._organised_cloud(reading.second, time_ns)

    def _echo_message(self, reading: LidarReading, time_ns: int) -> msgs.MultiEchoLaserScan:
        """Make a scan with all echoes of each ray, those with a reading, as the driver `urg_node` does."""
        scan, parts = self._scan_message(reading, time_ns), [reading]
        if reading.second is not None:
            parts.append(reading.second)
        n = self.options.horizontal.samples
        first = self.options.vertical.samples // 2 * n
        echoes = [[part for part in parts if not part.infinite[i]] for i in range(first, first + n)]
        make = msgs.type_of("sensor_msgs/msg/LaserEcho")
        names = "angle_min angle_max angle_increment time_increment scan_time range_min range_max"
        message: msgs.MultiEchoLaserScan = msgs.type_of(ECHOES)(
            header=scan.header,
            **{name: getattr(scan, name) for name in names.split()},
            ranges=[make(np.array([p.ranges[first + i] for p in ray], np.float32)) for i, ray in enumerate(echoes)],
            intensities=[
                make(np.array([p.intensities[first + i] for p in ray], np.float32)) for i, ray in enumerate(echoes)
            ],
        )
        return message

    def _cloud_of_hits(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud2:
        """Make a cloud of the rays with a reading, in one row."""
        hit = np.flatnonzero(np.isfinite(reading.ranges) & ~reading.infinite)
        return point_cloud(msgs.header(time_ns, self.frame_id), self._points(reading, hit, _POINT), 1, len(hit), True)

    def _points(self, reading: LidarReading, which: Ids | slice, dtype: np.dtype[np.void]) -> npt.NDArray[np.void]:
        """Return the points of some rays; fields other than position and intensity are 0."""
        ranges = reading.ranges[which]
        if self.artefacts:  # a ray without a return may read a number
            ranges = np.where(reading.infinite[which] & np.isfinite(ranges), np.inf, ranges)
        points = np.zeros(len(ranges), dtype)
        with np.errstate(invalid="ignore"):
            positions = self.directions_of(reading)[which] * ranges[:, None]
        for axis, name in enumerate("xyz"):
            points[name] = positions[:, axis]
        points["intensity"] = np.maximum(reading.intensities[which], self.min_intensity)
        return points

    def _velodyne_cloud(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud2:
        """Make a cloud of the points within `cloud_range`, layer by layer from the lowest.

        If `keeps_order` is set, the cloud has a point for every ray, which is NaN outside the range.
        """
        if not self.keeps_order:
            parts = [self._velodyne_points(part)[0] for part in (reading, reading.second) if part is not None]
            points = parts[0] if len(parts) == 1 else np.concatenate(parts)  # the driver writes both into one cloud
            return point_cloud(msgs.header(time_ns, self.frame_id), points, 1, len(points), True)
        height, width = self.options.vertical.samples, self.options.horizontal.samples
        points, in_range = self._velodyne_points(reading)
        for axis in "xyz":
            points[axis][~in_range] = np.nan
        return point_cloud(msgs.header(time_ns, self.frame_id), points, height, width, bool(in_range.all()))

    def _velodyne_points(self, reading: LidarReading) -> tuple[npt.NDArray[np.void], npt.NDArray[np.bool_]]:
        """Return the points of a `velodyne` cloud, and which rays are within `cloud_range`."""
        low, high = self.cloud_range
        in_range = (reading.ranges > low) & (reading.ranges < high) & (reading.intensities >= self.min_intensity)
        which = np.arange(self.fan.count) if self.keeps_order else np.flatnonzero(in_range)
        points = self._points(reading, which, _WIDE_POINT)
        points["ring"] = which // self.options.horizontal.samples
        return points, in_range

    def _old_cloud(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud:
        hit = np.flatnonzero(np.isfinite(reading.ranges) & ~reading.infinite)
        positions = self.directions_of(reading)[hit] * reading.ranges[hit, None]
        intensities = np.maximum(reading.intensities[hit], self.min_intensity)
        return legacy_point_cloud(msgs.header(time_ns, self.frame_id), positions, intensities)

    def _block_cloud(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud:
        """Make a cloud of all rays, layer by layer from the lowest; rays without a hit end at the range limit."""
        positions = self.directions_of(reading) * np.clip(reading.ranges, *self._limits)[:, None]
        intensities = np.maximum(reading.intensities, self.min_intensity)
        if reading.scatter is not None:
            positions[~reading.infinite] += reading.scatter[~reading.infinite, :3]
            intensities = intensities + reading.scatter[:, 3]
        return legacy_point_cloud(msgs.header(time_ns, self.frame_id), positions, intensities)

    def _range_message(self, reading: LidarReading, time_ns: int) -> msgs.Range:
        """Make a range message of the nearest hit."""
        o = self.options
        view = max(o.horizontal.high - o.horizontal.low, o.vertical.high - o.vertical.low)
        return msgs.Range(
            header=msgs.header(time_ns, self.frame_id),
            radiation_type=self.radiation,
            field_of_view=view if self.field_of_view is None else self.field_of_view,
            min_range=o.range_min,
            max_range=o.range_max,
            range=float(reading.ranges.min()),
            variance=0.0,
        )
