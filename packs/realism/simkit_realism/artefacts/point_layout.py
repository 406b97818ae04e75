"""Clouds of a lidar in the layouts of the drivers of Velodyne, Ouster, Hesai and Livox: time and ring of each point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Params, msgs
from simkit.extend import Artefact, LidarReading, Product, Sensor, Vector
from simkit.sensors.point_cloud_messages import point_cloud
from simkit.sensors.rays.lidar import CLOUD, Lidar

LIVOX_TYPE: Final = "livox_ros_driver2/msg/CustomMsg"
_XYZI: Final = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4")]
_PRODUCTS: Final = ("points", "hits", "velodyne")
"""Clouds that the layout replaces, whichever topic a plugin gives them."""
_BRIGHTEST: Final = 255.0


@dataclass(frozen=True, slots=True)
class Layout:
    """Points of one driver.

    Attributes:
        dtype: fields of a point with their offsets [bytes].
        is_organised: True for a row for each ring and a column for each firing.
        lost: coordinates of a point without a return [m]; None if the cloud leaves such points out.
        is_from_top: True if ring 0 is the highest layer, else the lowest.
    """

    dtype: np.dtype[np.void]
    is_organised: bool = False
    lost: float | None = None
    is_from_top: bool = False


_OUSTER = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "t", "reflectivity", "ring", "ambient", "range"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u4", "<u2", "<u2", "<u2", "<u4"],
        "offsets": [0, 4, 8, 16, 20, 24, 26, 28, 32],
        "itemsize": 48,
    }
)
LAYOUTS: Final[Mapping[str, Layout]] = {
    # the plugin for Gazebo Classic, livox_points_plugin.cpp: a point at the origin for no return
    "xyz": Layout(np.dtype(_XYZI[:3]), lost=0.0),
    # velodyne_pointcloud, pointcloudXYZIRT.cc: `time` [s] after the stamp
    "velodyne": Layout(np.dtype([*_XYZI, ("ring", "<u2"), ("time", "<f4")])),
    # ouster_ros, os_point.h and point_cloud_compose.h: `t` [ns] after the stamp, `range` [mm]
    "ouster": Layout(_OUSTER, is_organised=True, lost=np.nan, is_from_top=True),
    # hesai_ros_driver, source_driver_ros2.hpp: `timestamp` [s] of the clock, as the stamp
    "hesai": Layout(np.dtype([*_XYZI, ("ring", "<u2"), ("timestamp", "<f8")]), is_from_top=True),
    # livox_ros_driver2, lddc.cpp: `timestamp` [ns] of the clock; the device sends points at the origin for no return
    "livox": Layout(np.dtype([*_XYZI, ("tag", "u1"), ("line", "u1"), ("timestamp", "<f8")]), lost=0.0),
    "livox_custom": Layout(np.dtype([*_XYZI, ("tag", "u1"), ("line", "u1"), ("timestamp", "<f8")]), lost=0.0),
}


class PointLayout(Artefact):
    """`<simkit:point_layout>` of a lidar: its clouds have the fields of a driver, with time and ring of each point.

    Args:
        params: the element, whose text is `velodyne`, `ouster`, `hesai`, `livox`, `xyz` (each a `PointCloud2`) or
            `livox_custom` (`livox_ros_driver2/msg/CustomMsg`).
        sensor: the lidar.
    """

    elements = ("lidar/point_layout",)
    sensor: Lidar

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._name = params.value.strip()
        if self._name not in LAYOUTS:
            allowed = ", ".join(LAYOUTS)
            params.error("SK-SENSOR-280", f"found a layout of points {self._name!r}; expected one of {allowed}")
            self._name = "velodyne"
        self._layout = LAYOUTS[self._name]

    def prepare(self) -> None:
        if self._name == "livox_custom":
            product = Product(LIVOX_TYPE, self._livox_message)
        else:
            product = Product(CLOUD, self._cloud)
        self.sensor.replaced_products = dict.fromkeys(_PRODUCTS, product)

    def apply(self, reading: LidarReading, truth: LidarReading, index: int) -> LidarReading:
        return reading

    # ------------------------------------------------------------------ points

    @cached_property
    def _rings(self) -> npt.NDArray[np.intp]:
        """Ring of each ray, shape (layers · samples,)."""
        options = self.sensor.options
        rings = np.repeat(np.arange(options.vertical.samples), options.horizontal.samples)
        return options.vertical.samples - 1 - rings if self._layout.is_from_top else rings

    def _order(self, times: Vector) -> npt.NDArray[np.intp]:
        """Return the rays in the order of the message: by time, then by ring; by ring, then by time if organised."""
        keys = (times, self._rings) if self._layout.is_organised else (self._rings, times)
        return np.lexsort(keys)

    def _points(self, reading: LidarReading, time_ns: int) -> npt.NDArray[np.void]:
        """Return the points of a reading in the order of the message."""
        layout = self._layout
        sweep = reading.sweep
        times: Vector = np.zeros(len(reading.ranges)) if sweep is None else sweep.ray_times
        which = self._order(times)
        ranges = reading.ranges[which]
        is_lost = reading.infinite[which] | ~np.isfinite(ranges)
        if layout.lost is None:
            which, ranges = which[~is_lost], ranges[~is_lost]
            is_lost = is_lost[:0]
        points = np.zeros(len(which), layout.dtype)
        with np.errstate(invalid="ignore"):
            positions = self.sensor.directions_of(reading)[which] * ranges[:, None]
        if layout.lost is not None:
            positions[is_lost] = layout.lost
        for axis, name in enumerate("xyz"):
            points[name] = positions[:, axis]
        self._fill(points, reading, which, times[which], time_ns)
        return points

    def _fill(
        self,
        points: npt.NDArray[np.void],
        reading: LidarReading,
        which: npt.NDArray[np.intp],
        times: Vector,
        time_ns: int,
    ) -> None:
        """Fill the fields besides the position."""
        names = points.dtype.names or ()
        intensities = np.maximum(reading.intensities[which], self.sensor.min_intensity)
        if "intensity" in names:
            points["intensity"] = intensities
        if "ring" in names:
            points["ring"] = self._rings[which]
        if "line" in names:
            points["line"] = self._rings[which]
        if "time" in names:
            points["time"] = times
        if "timestamp" in names and self._name == "hesai":
            points["timestamp"] = time_ns * 1e-9 + times
        elif "timestamp" in names:
            points["timestamp"] = time_ns + np.rint(times * 1e9)
        if "t" in names:
            points["t"] = np.rint(times * 1e9)
            has_return = np.isfinite(reading.ranges[which]) & ~reading.infinite[which]
            points["range"] = np.where(has_return, reading.ranges[which] * 1000.0, 0.0)
            points["reflectivity"] = np.clip(intensities, 0.0, 65535.0)

    # ------------------------------------------------------------------ messages

    def _cloud(self, reading: LidarReading, time_ns: int) -> msgs.PointCloud2:
        points = self._points(reading, time_ns)
        height = self.sensor.options.vertical.samples if self._layout.is_organised else 1
        is_dense = self._layout.lost is None or bool(np.isfinite(points["x"]).all())
        header = msgs.header(time_ns, self.sensor.frame_id)
        return point_cloud(header, points, height, len(points) // height, is_dense)

    def _livox_message(self, reading: LidarReading, time_ns: int) -> object:
        points = self._points(reading, time_ns)
        make, make_point = msgs.type_of(LIVOX_TYPE), msgs.type_of("livox_ros_driver2/msg/CustomPoint")
        offsets = (points["timestamp"] - time_ns).astype(np.int64).tolist()
        levels = np.clip(np.rint(points["intensity"]), 0.0, _BRIGHTEST).astype(np.int64).tolist()
        rows = zip(offsets, *(points[axis].tolist() for axis in "xyz"), levels, points["line"].tolist(), strict=True)
        clouded = [make_point(offset, x, y, z, level, 0, line) for offset, x, y, z, level, line in rows]
        header = msgs.header(time_ns, self.sensor.frame_id)
        return make(header, time_ns, len(clouded), 0, np.zeros(3, np.uint8), clouded)
