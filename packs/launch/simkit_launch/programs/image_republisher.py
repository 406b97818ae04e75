"""image_transport's republish: an image topic with another transport, raw or compressed."""

from __future__ import annotations

import sys
from typing import Any

import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from republisher import run
from sensor_msgs.msg import CompressedImage, Image

TRANSPORTS = ("raw", "compressed")


class ImageRepublisher(Node):
    """Node that reads `in` and publishes `out`; compressed topics have names such as `in/compressed`.

    Args:
        words: transport of the input and of the output.
    """

    def __init__(self, words: list[str]) -> None:
        super().__init__("image_republisher")
        given = [*words, "", ""]
        self._in = str(self.declare_parameter("in_transport", given[0] or "raw").value) or "raw"
        self._out = str(self.declare_parameter("out_transport", given[1]).value)
        for transport in filter(None, (self._in, self._out)):
            if transport not in TRANSPORTS:
                self.get_logger().error(f"the transport {transport!r} is not known; there are {', '.join(TRANSPORTS)}")
                raise SystemExit(1)
        self._bridge = CvBridge()
        self._publishers = {
            name: self.create_publisher(*topic, 10)
            for name, topic in (("raw", (Image, "out")), ("compressed", (CompressedImage, "out/compressed")))
            if self._out in ("", name)
        }
        kind, topic = (Image, "in") if self._in == "raw" else (CompressedImage, "in/compressed")
        self.create_subscription(kind, topic, self._publish, qos_profile_sensor_data)

    def _publish(self, message: Any) -> None:
        for name, publisher in self._publishers.items():
            if publisher.get_subscription_count():
                publisher.publish(message if name == self._in else self._converted(message, name))

    def _converted(self, message: Any, transport: str) -> Any:
        if transport == "raw":
            image = self._bridge.cv2_to_imgmsg(self._bridge.compressed_imgmsg_to_cv2(message), "bgr8")
            image.header = message.header
            return image
        colours = self._bridge.imgmsg_to_cv2(message, "bgr8" if "8" in message.encoding else "passthrough")
        compressed = self._bridge.cv2_to_compressed_imgmsg(colours, "jpg" if colours.dtype == "uint8" else "png")
        compressed.header = message.header
        return compressed


def main() -> None:
    """Run the node."""
    rclpy.init()
    words = [word for word in remove_ros_args(sys.argv)[1:] if ":=" not in word]
    run(ImageRepublisher(words))


if __name__ == "__main__":
    main()
