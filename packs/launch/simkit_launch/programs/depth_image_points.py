"""depth_image_proc's conversion of depth images to point clouds, with and without colours."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from republisher import run
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField
from sensor_msgs_py.point_cloud2 import create_cloud


class DepthPoints(Node):
    """Node that publishes `points` from depth images.

    Args:
        has_colours: True for points with the colours of `rgb/image_rect_color`.
    """

    def __init__(self, *, has_colours: bool) -> None:
        super().__init__("point_cloud_xyzrgb" if has_colours else "point_cloud_xyz")
        self._has_colours = has_colours
        self._info: Any = None
        self._colours: Any = None
        self._bridge = CvBridge()
        self._publisher = self.create_publisher(PointCloud2, "points", qos_profile_sensor_data)
        info, depth = "camera_info", "image_rect"
        if has_colours:
            info, depth = "rgb/camera_info", "depth_registered/image_rect"
            self.create_subscription(Image, "rgb/image_rect_color", self._receive_colours, qos_profile_sensor_data)
        self.create_subscription(CameraInfo, info, self._receive_info, qos_profile_sensor_data)
        self.create_subscription(Image, depth, self._convert, qos_profile_sensor_data)

    def _receive_info(self, info: Any) -> None:
        self._info = info

    def _receive_colours(self, image: Any) -> None:
        self._colours = image

    def _convert(self, image: Any) -> None:
        if self._info is None or (self._has_colours and self._colours is None):
            return
        depth = self._bridge.imgmsg_to_cv2(image, "passthrough").astype(np.float32)
        if image.encoding in ("16UC1", "mono16"):
            depth = np.where(depth == 0.0, np.nan, depth / 1000.0).astype(np.float32)
        depth = np.where(np.isfinite(depth), depth, np.nan).astype(np.float32)
        k = self._info.k
        x = (np.arange(image.width) - k[2]) * depth / k[0]
        y = (np.arange(image.height)[:, None] - k[5]) * depth / k[4]
        columns = [x, y, depth]
        fields = [PointField(name=n, offset=4 * i, datatype=PointField.FLOAT32, count=1) for i, n in enumerate("xyz")]
        if self._has_colours:
            colours = self._bridge.imgmsg_to_cv2(self._colours, "bgr8").astype(np.uint32)
            packed = colours[..., 2] << 16 | colours[..., 1] << 8 | colours[..., 0]
            columns.append(packed.view(np.float32))
            fields.append(PointField(name="rgb", offset=12, datatype=PointField.FLOAT32, count=1))
        points = np.stack([column.astype(np.float32) for column in columns], axis=-1)
        self._publisher.publish(create_cloud(image.header, fields, points))


def main() -> None:
    """Run the node that the name of the executable names."""
    rclpy.init()
    run(DepthPoints(has_colours="rgb" in sys.argv[0].lower()))


if __name__ == "__main__":
    main()
