"""Map savers of ROS: `map_saver_cli` writes one map and ends, `map_saver_server` has a service."""

import argparse
import sys
from pathlib import Path

import rclpy
from nav2_msgs.srv import SaveMap
from nav_msgs.msg import OccupancyGrid
from node_support import ServerNode, run
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args
from rclpy.wait_for_message import wait_for_message

from simkit_navigation.plugins.maps.map_saver import MapNotSaved, write_map

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def save(node, topic, url, mode, ending, thresholds, timeout):
    """Save the map of a topic; return True if that was possible."""
    node.get_logger().info(f"Saving map from '{topic}' topic to '{url}' file")
    is_there, message = wait_for_message(OccupancyGrid, node, topic, qos_profile=LATCHED, time_to_wait=timeout)
    if not is_there:
        node.get_logger().error("Failed to spin map subscription")
        return False
    stem = Path(url.removeprefix("file://")).expanduser()
    try:
        file = write_map(message, stem.absolute(), mode, ending, thresholds)
    except (MapNotSaved, OSError) as error:
        node.get_logger().error(f"Failed to save the map: {error}")
        return False
    node.get_logger().info(f"Map saved successfully: {file}")
    return True


class MapSaver(ServerNode):
    """Node with the service `~/save_map` while it is active."""

    def __init__(self):
        super().__init__("map_saver")
        self.declare_parameter("save_map_timeout", 2.0)
        self.declare_parameter("free_thresh_default", 0.25)
        self.declare_parameter("occupied_thresh_default", 0.65)
        self.declare_parameter("map_subscribe_transient_local", True)

    def on_configure(self, state):
        """Open the service."""
        super().on_configure(state)
        self._readers = Node(f"{self.get_name()}_reader", namespace=self.get_namespace(), use_global_arguments=False)
        self._service = self.create_service(SaveMap, "~/save_map", self._on_save)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the service."""
        self.destroy_service(self._service)
        return TransitionCallbackReturn.SUCCESS

    def _on_save(self, request, response):
        free = request.free_thresh or self.get_parameter("free_thresh_default").value
        occupied = request.occupied_thresh or self.get_parameter("occupied_thresh_default").value
        topic, url = request.map_topic or "map", request.map_url or "map"
        mode, ending = request.map_mode or "trinary", request.image_format or "pgm"
        timeout = self.get_parameter("save_map_timeout").value
        response.result = save(self._readers, topic, url, mode, ending, (free, occupied), timeout)
        return response


def _parsed(words):
    parser = argparse.ArgumentParser(prog="map_saver_cli", description="Save a map")
    parser.add_argument("-t", dest="topic", default="map", help="topic of the map")
    parser.add_argument("-f", dest="file", default="map", help="path of the files without ending")
    parser.add_argument("--occ", type=float, default=0.65, help="smallest occupancy of an occupied cell, or percent")
    parser.add_argument("--free", type=float, default=0.25, help="largest occupancy of a free cell, or percent")
    parser.add_argument("--fmt", default="pgm", help="format of the image")
    parser.add_argument("--mode", default="trinary", help="trinary, scale or raw")
    return parser.parse_args(words)


def main():
    """Run the server, or save one map."""
    rclpy.init(args=sys.argv)
    if sys.argv[0].endswith(("map_saver_server", "::MapSaver")):
        run(MapSaver())
        return
    values = _parsed([word for word in remove_ros_args(args=sys.argv)[1:] if ":=" not in word])
    node = Node("map_saver")
    timeout = node.declare_parameter("save_map_timeout", 2.0).value
    free, occupied = (value / 100.0 if value > 1.0 else value for value in (values.free, values.occ))
    try:
        is_saved = save(node, values.topic, values.file, values.mode, values.fmt, (free, occupied), timeout)
    except (KeyboardInterrupt, ExternalShutdownException):
        is_saved = False
    sys.exit(0 if is_saved else 1)


if __name__ == "__main__":
    main()
