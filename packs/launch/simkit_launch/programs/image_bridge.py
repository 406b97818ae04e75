"""`ros_gz_image image_bridge`: connects image topics of Gazebo with those of ROS."""

from __future__ import annotations

import sys
from contextlib import closing, suppress
from functools import partial

import rclpy
from cv_bridge import CvBridge
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import CompressedImage, Image

from simkit_launch.bridge_rules import BridgeRule
from simkit_launch.program_simulation import current_simulation
from simkit_launch.topic_bridge import TopicBridge
from simkit_nodes.host import current_program

_PERIOD = 0.1


class ImageBridge(Node):
    """Node of the bridge.

    Args:
        topics: topics of images.
    """

    def __init__(self, topics: list[str]) -> None:
        super().__init__("ros_gz_image")
        self.declare_parameter("qos", "default")
        self._bridge = TopicBridge(current_simulation(), self.get_fully_qualified_name(), self.get_logger().error)
        for topic in topics:
            rule = BridgeRule(topic, topic, "sensor_msgs/msg/Image", "gz.msgs.Image", "GZ_TO_ROS")
            self._bridge.add(rule, topic, self.resolve_topic_name(topic))
        self._images = CvBridge()
        self._compressed = {}
        for topic in topics:
            out = self.create_publisher(CompressedImage, f"{self.resolve_topic_name(topic)}/compressed", 5)
            self._compressed[topic] = out
        self._sources = {}
        self.create_timer(_PERIOD, self._look)
        self._bridge.connect()
        current_program().on_report.append(self._bridge.report_missing)

    def _look(self) -> None:
        """Connect topics that have appeared, and compress images while somebody subscribes to compressed ones."""
        if not self._bridge.is_complete:
            self._bridge.connect()
        for topic, out in self._compressed.items():
            is_wanted = out.get_subscription_count() > 0
            if is_wanted and topic not in self._sources:
                source = self.create_subscription(Image, topic, partial(self._compress, out), qos_profile_sensor_data)
                self._sources[topic] = source
            elif not is_wanted and topic in self._sources:
                self.destroy_subscription(self._sources.pop(topic))

    def _compress(self, out, message: Image) -> None:
        has_colours = "8" in message.encoding
        picture = self._images.imgmsg_to_cv2(message, "bgr8" if has_colours else "passthrough")
        compressed = self._images.cv2_to_compressed_imgmsg(picture, "jpg" if has_colours else "png")
        compressed.header = message.header
        compressed.format = f"{message.encoding}; " + ("jpeg compressed bgr8" if has_colours else "png compressed ")
        out.publish(compressed)

    def close(self) -> None:
        """Close all connections."""
        self._bridge.close()


def main() -> int:
    """Run the bridge until the end of the run; return the exit code."""
    rclpy.init(args=sys.argv)
    topics = remove_ros_args(sys.argv)[1:]
    if not topics:
        sys.stderr.write("usage: image_bridge TOPIC …\n")
        return 255
    with closing(ImageBridge(topics)) as node, suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)
    return 0


if __name__ == "__main__":
    sys.exit(main())
