"""Map server of Nav2: publishes a map of a file while it is active, and loads others."""

import sys
from pathlib import Path

import rclpy
from nav2_msgs.srv import LoadMap
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from node_support import ServerNode, run
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile

from simkit_navigation.plugins.maps.map_server import MapFileError, read_map


class MapServer(ServerNode):
    """Node with the topic `map` and the services `~/map` and `~/load_map`."""

    def __init__(self):
        super().__init__("map_server")
        self.declare_parameter("yaml_filename", "")
        self.declare_parameter("topic_name", "map")
        self.declare_parameter("frame_id", "map")
        self._map = None

    def on_configure(self, state):
        """Read the map of the parameter `yaml_filename`."""
        super().on_configure(state)
        file = self.get_parameter("yaml_filename").value
        if not file:
            self.get_logger().info("yaml-filename parameter is empty, set map through '~/load_map' service")
        elif self._load(file) != LoadMap.Response.RESULT_SUCCESS:
            return TransitionCallbackReturn.FAILURE
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = self.create_publisher(OccupancyGrid, self.get_parameter("topic_name").value, qos)
        self._services_of_map = [
            self.create_service(GetMap, "~/map", self._on_get_map),
            self.create_service(LoadMap, "~/load_map", self._on_load_map),
        ]
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state):
        """Publish the map."""
        super().on_activate(state)
        if self._map is not None:
            self._publisher.publish(self._map)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topic and the services."""
        super().on_cleanup(state)
        self.destroy_publisher(self._publisher)
        for service in self._services_of_map:
            self.destroy_service(service)
        self._map = None
        return TransitionCallbackReturn.SUCCESS

    def _load(self, url):
        """Read a map; return the result of `nav2_msgs/srv/LoadMap`."""
        path = url.removeprefix("file://")
        self.get_logger().info(f"Loading yaml file: {path}")
        try:
            if not Path(path).is_file():
                raise MapFileError(f"there is no file {path}", LoadMap.Response.RESULT_MAP_DOES_NOT_EXIST)
            occupancy = read_map(Path(path))
        except MapFileError as error:
            self.get_logger().error(f"Failed to load the map: {error}")
            return error.result
        message, (rows, columns) = OccupancyGrid(), occupancy.cells.shape
        message.header.frame_id = self.get_parameter("frame_id").value
        message.header.stamp = message.info.map_load_time = self.get_clock().now().to_msg()
        message.info.resolution, message.info.width, message.info.height = occupancy.resolution, columns, rows
        position, turn = message.info.origin.position, message.info.origin.orientation
        position.x, position.y, position.z = map(float, occupancy.origin.position)
        turn.w, turn.x, turn.y, turn.z = map(float, occupancy.origin.quaternion)
        message.data = occupancy.cells.reshape(-1).tolist()
        self._map = message
        self.get_logger().info(f"Read map {path}: {columns} X {rows} map @ {occupancy.resolution:g} m/cell")
        return LoadMap.Response.RESULT_SUCCESS

    def _on_get_map(self, request, response):
        if self._is_active and self._map is not None:
            response.map = self._map
        return response

    def _on_load_map(self, request, response):
        response.result = self._load(request.map_url) if self._is_active else response.RESULT_UNDEFINED_FAILURE
        if response.result == response.RESULT_SUCCESS:
            response.map = self._map
            self._publisher.publish(self._map)
        return response


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(MapServer())


if __name__ == "__main__":
    main()
