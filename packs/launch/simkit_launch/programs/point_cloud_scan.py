"""pointcloud_to_laserscan, and laserscan_to_pointcloud."""

from __future__ import annotations

import math
import sys
from pathlib import PurePath
from typing import Any

import numpy as np
import rclpy
import tf2_ros
from laser_geometry import LaserProjection
from node_values import value_of
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from republisher import run
from sensor_msgs.msg import LaserScan, PointCloud2
from sensor_msgs_py.point_cloud2 import read_points
from tf2_sensor_msgs import do_transform_cloud

from simkit.elementary_functions import arctan2


class Converter(Node):
    """Node that converts messages, in the frame of a parameter if it is set.

    Args:
        name: name of the node.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.target = str(self.value("target_frame", ""))
        self.value("transform_tolerance", 0.01)
        self.value("queue_size", 1)
        self._buffer = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._buffer, self) if self.target else None

    def value(self, name: str, default: Any) -> Any:
        """Declare a parameter and return its value."""
        return value_of(self, name, default)

    def in_target(self, cloud: Any) -> Any:
        """Return a cloud in the target frame; None if there is no transform."""
        if not self.target or cloud.header.frame_id == self.target:
            return cloud
        try:
            stamp = Time.from_msg(cloud.header.stamp)
            transform = self._buffer.lookup_transform(self.target, cloud.header.frame_id, stamp, Duration())
        except tf2_ros.TransformException:
            try:
                transform = self._buffer.lookup_transform(self.target, cloud.header.frame_id, Time())
            except tf2_ros.TransformException as error:
                self.get_logger().error(f"Transform failure: {error}", throttle_duration_sec=1.0)
                return None
        return do_transform_cloud(cloud, transform)


class CloudToScan(Converter):
    """Node that publishes the nearest point of `cloud_in` in each direction as `scan`."""

    def __init__(self) -> None:
        super().__init__("pointcloud_to_laserscan")
        self._heights = self.value("min_height", sys.float_info.min), self.value("max_height", sys.float_info.max)
        self._angles = self.value("angle_min", -math.pi), self.value("angle_max", math.pi)
        self._increment = self.value("angle_increment", math.pi / 180)
        self._scan_time = self.value("scan_time", 1 / 30)
        self._ranges = self.value("range_min", 0.0), self.value("range_max", sys.float_info.max)
        self._beyond, self._use_inf = self.value("inf_epsilon", 1.0), self.value("use_inf", True)
        self._publisher = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        self.create_subscription(PointCloud2, "cloud_in", self._convert, qos_profile_sensor_data)

    def _convert(self, cloud: Any) -> None:
        cloud = self.in_target(cloud)
        if cloud is None:
            return
        points = read_points(cloud, field_names=("x", "y", "z"), skip_nans=True)
        x, y, z = (np.asarray(points[name], np.float64).ravel() for name in "xyz")
        distance, angle = np.hypot(x, y), arctan2(y, x)
        least, most = self._ranges
        begin, end = self._angles
        is_used = (z >= self._heights[0]) & (z <= self._heights[1]) & (distance >= least) & (distance <= most)
        is_used &= (angle >= begin) & (angle <= end)
        count = math.ceil((end - begin) / self._increment)
        empty = math.inf if self._use_inf else most + self._beyond
        ranges = np.full(count, empty)
        index = ((angle[is_used] - begin) / self._increment).astype(np.intp).clip(0, count - 1)
        np.minimum.at(ranges, index, distance[is_used])
        scan = LaserScan(header=cloud.header, scan_time=float(self._scan_time))
        scan.header.frame_id = self.target or cloud.header.frame_id
        scan.angle_min, scan.angle_max, scan.angle_increment = float(begin), float(end), float(self._increment)
        scan.range_min, scan.range_max = float(least), min(float(most), float(np.finfo(np.float32).max))
        scan.ranges = ranges.clip(max=None if self._use_inf else scan.range_max).tolist()
        self._publisher.publish(scan)


class ScanToCloud(Converter):
    """Node that publishes the points of `scan_in` as `cloud`."""

    def __init__(self) -> None:
        super().__init__("laserscan_to_pointcloud")
        self._projection = LaserProjection()
        self._publisher = self.create_publisher(PointCloud2, "cloud", qos_profile_sensor_data)
        self.create_subscription(LaserScan, "scan_in", self._convert, qos_profile_sensor_data)

    def _convert(self, scan: Any) -> None:
        cloud = self.in_target(self._projection.projectLaser(scan))
        if cloud is not None:
            self._publisher.publish(cloud)


def main() -> None:
    """Run the node that the name of the executable names."""
    rclpy.init()
    name = PurePath(sys.argv[0]).name.lower()
    run(ScanToCloud() if name.startswith(("laserscan", "pointcloud_to_laserscan::laserscan")) else CloudToScan())


if __name__ == "__main__":
    main()
