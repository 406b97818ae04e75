"""depthimage_to_laserscan: a laser scan from the middle rows of a depth image."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import rclpy
from cv_bridge import CvBridge
from node_values import value_of
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from republisher import run
from sensor_msgs.msg import CameraInfo, Image, LaserScan

from simkit.elementary_functions import arctan


class DepthImageScan(Node):
    """Node that publishes `scan` from `depth` and `depth_camera_info`; in ROS 1 they are `image` and `camera_info`."""

    def __init__(self) -> None:
        super().__init__("depthimage_to_laserscan")
        self._scan_time = self._value("scan_time", 0.033)
        self._limits = self._value("range_min", 0.45), self._value("range_max", 10.0)
        self._height = int(self._value("scan_height", 1))
        self._frame = str(self._value("output_frame", "") or self._value("output_frame_id", "") or "camera_depth_frame")
        self._info: Any = None
        self._bridge = CvBridge()
        self._publisher = self.create_publisher(LaserScan, "scan", qos_profile_sensor_data)
        for image, info in (("depth", "depth_camera_info"), ("image", "camera_info")):
            self.create_subscription(CameraInfo, info, self._receive_info, qos_profile_sensor_data)
            self.create_subscription(Image, image, self._convert, qos_profile_sensor_data)

    def _value(self, name: str, default: Any) -> Any:
        return value_of(self, name, default)

    def _receive_info(self, info: Any) -> None:
        self._info = info

    def _convert(self, image: Any) -> None:
        if self._info is None:
            return
        depth = self._bridge.imgmsg_to_cv2(image, "passthrough").astype(np.float32)
        if image.encoding in ("16UC1", "mono16"):
            depth = depth / 1000.0
        fx, cx, cy = self._info.k[0], self._info.k[2], self._info.k[5]
        first = int(cy - self._height / 2)
        if first < 0 or first + self._height > image.height:
            self.get_logger().error(f"scan_height ( {self._height} pixels) is too large for the image height.")
            return
        slopes = (np.arange(image.width) - cx) / fx
        angles = -arctan(slopes)
        distances = depth[first : first + self._height] * np.sqrt(1.0 + slopes**2)
        least, most = self._limits
        usable = np.where((distances >= least) & (distances <= most), distances, np.inf).min(axis=0)
        seen = np.where(np.isfinite(distances), -np.inf, np.where(np.isnan(distances), -np.inf, distances)).max(axis=0)
        nearest = np.where(np.isfinite(usable), usable, np.where(np.isposinf(seen), np.inf, np.nan))
        scan = LaserScan(header=image.header, scan_time=float(self._scan_time))
        scan.header.frame_id = self._frame
        scan.angle_min, scan.angle_max = float(angles[-1]), float(angles[0])
        scan.angle_increment = (scan.angle_max - scan.angle_min) / (image.width - 1)
        scan.range_min, scan.range_max = float(least), float(most)
        columns = np.round((angles - scan.angle_min) / scan.angle_increment).astype(np.intp)
        ranges = np.full(image.width, math.nan)
        np.fmin.at(ranges, columns, nearest)
        scan.ranges = ranges.tolist()
        self._publisher.publish(scan)


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(DepthImageScan())


if __name__ == "__main__":
    main()
