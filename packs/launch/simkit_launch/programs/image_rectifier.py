"""image_proc's rectification: images without the distortion of their lens."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from republisher import run
from sensor_msgs.msg import CameraInfo, Image


class Rectifier(Node):
    """Node that publishes `image` and `camera_info` as `image_rect`."""

    def __init__(self) -> None:
        super().__init__("rectify_node")
        self._info: Any = None
        self._bridge = CvBridge()
        self._publisher = self.create_publisher(Image, "image_rect", 10)
        self.create_subscription(CameraInfo, "camera_info", self._receive_info, qos_profile_sensor_data)
        self.create_subscription(Image, "image", self._rectify, qos_profile_sensor_data)

    def _receive_info(self, info: Any) -> None:
        self._info = info

    def _rectify(self, image: Any) -> None:
        if self._info is None or not self._publisher.get_subscription_count():
            return
        distortion = np.array(self._info.d)
        if not distortion.any():
            self._publisher.publish(image)
            return
        matrix = np.array(self._info.k).reshape(3, 3)
        rectified = cv2.undistort(self._bridge.imgmsg_to_cv2(image, "passthrough"), matrix, distortion)
        message = self._bridge.cv2_to_imgmsg(rectified, image.encoding)
        message.header = image.header
        self._publisher.publish(message)


def main() -> None:
    """Run the node."""
    rclpy.init()
    run(Rectifier())


if __name__ == "__main__":
    main()
