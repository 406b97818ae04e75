"""SLAM: slam_toolbox, gmapping and others are replaced by one mapper without closed loops."""

import math
import sys

import numpy as np
import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from node_support import run, warn
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

from simkit_navigation.plugins.maps.scan_mapper import ScanMapper
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose
from simkit_nodes.host import current_host

DEFAULTS = {
    "odom_frame": "odom",
    "map_frame": "map",
    "base_frame": "base_footprint",
    "scan_topic": "/scan",
    "mode": "mapping",
    "map_name": "/map",
    "resolution": 0.05,
    "max_laser_range": 80.0,
    "minimum_time_interval": 0.5,
    "minimum_travel_distance": 0.5,
    "minimum_travel_heading": 0.5,
    "map_update_interval": 10.0,
    "transform_publish_period": 0.05,
    "transform_timeout": 0.2,
    "map_start_pose": [0.0, 0.0, 0.0],
}
"""Parameters of slam_toolbox that have an effect, with their defaults."""


OF_GMAPPING = {
    "base_frame": "base_frame",
    "odom_frame": "odom_frame",
    "map_frame": "map_frame",
    "delta": "resolution",
    "maxUrange": "max_laser_range",
    "linearUpdate": "minimum_travel_distance",
    "angularUpdate": "minimum_travel_heading",
    "map_update_interval": "map_update_interval",
}
"""Parameters of slam_toolbox by those of gmapping."""
DEFAULTS_OF_OTHERS = {
    "gmapping/slam_gmapping": {
        "base_frame": "base_link",
        "scan_topic": "scan",
        "minimum_travel_distance": 1.0,
        "map_update_interval": 5.0,
    },
    "cartographer_ros/cartographer_node": {
        "scan_topic": "scan",
        "minimum_travel_distance": 0.2,
        "minimum_travel_heading": 0.2,
        "map_update_interval": 1.0,
    },
}
"""Defaults that differ from those of slam_toolbox."""


def parameters_of_ros1(node):
    """Return the private parameters of a node of ROS 1 with the names of slam_toolbox."""
    server = current_host().graph.shared.get("ROS 1 parameters")
    name = node.get_fully_qualified_name()
    values = server.get(name) if server is not None and server.has(name) else {}
    values |= {name: node.get_parameter(name).value for name in OF_GMAPPING if node.has_parameter(name)}
    return {OF_GMAPPING[name]: value for name, value in values.items() if name in OF_GMAPPING}


class Slam(LifecycleNode):
    """Node that makes a map from its start on, whatever its state."""

    def __init__(self):
        executable = sys.argv[0].partition("/")[2]
        name = executable if sys.argv[0] in DEFAULTS_OF_OTHERS else "slam_toolbox"
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        values = {**DEFAULTS, **DEFAULTS_OF_OTHERS.get(sys.argv[0], {})}
        if sys.argv[0].startswith("gmapping/"):
            values |= parameters_of_ros1(self)
        for name, value in values.items():
            if not self.has_parameter(name):
                self.declare_parameter(name, value)
        values = {name: self.get_parameter(name).value for name in values}
        if sys.argv[0] in DEFAULTS_OF_OTHERS:
            warn(self, "SK-NAV-001", f"a mapper that matches scans, without closed loops, replaces {executable}")
        self._values = values
        if values["mode"] == "localization":
            warn(self, "SK-NAV-001", "a new map is made; the localisation in a stored pose graph is not available")
        x, y, yaw = values["map_start_pose"] or (0.0, 0.0, 0.0)
        self._mapper = ScanMapper(float(values["resolution"]), float(values["max_laser_range"]))
        self._correction = PlanarPose(float(x), float(y), float(yaw))  # pose of the odometry in the map
        self._is_begun = False
        self._odometry = None  # pose of the robot in the odometry at the last scan of the map
        self._pending, self._last_ns = None, None
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = TransformBroadcaster(self)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = self.create_publisher(OccupancyGrid, values["map_name"], latched)
        self.create_subscription(LaserScan, values["scan_topic"], self._on_scan, qos_profile_sensor_data)
        self.create_service(GetMap, "~/dynamic_map", self._on_get_map)
        self.create_timer(max(float(values["transform_publish_period"]), 0.01), self._on_timer)
        self.create_timer(float(values["map_update_interval"]), self._publish_map)

    def on_configure(self, state):
        """Do nothing: the node works from its start."""
        return TransitionCallbackReturn.SUCCESS

    def _on_scan(self, scan):
        self._pending = scan

    def _on_timer(self):
        if self._pending is not None:
            self._use_if_known(self._pending)
        if self._mapper.scans:
            self._broadcast()

    def _use_if_known(self, scan):
        """Use a scan as soon as its transforms are known."""
        values, stamp = self._values, Time.from_msg(scan.header.stamp)
        try:
            base = _planar(self._buffer.lookup_transform(values["odom_frame"], values["base_frame"], stamp))
            sensor = _planar(self._buffer.lookup_transform(values["base_frame"], scan.header.frame_id, stamp))
        except TransformException:
            return
        self._pending = None
        if not self._is_new(base, stamp.nanoseconds):
            return
        predicted = self._correction.compose(base)
        if not self._is_begun:  # the robot is at the start pose of the map
            self._is_begun, predicted = True, self._correction
        ranges = np.asarray(scan.ranges, np.float64)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        self._mapper.add_scan(predicted, sensor, ranges, angles, float(scan.range_max))
        self._correction = self._mapper.pose.compose(_inverse(base))
        self._odometry, self._last_ns = base, stamp.nanoseconds
        if self._mapper.scans == 1:
            self.get_logger().info(f"Registering sensor: [{scan.header.frame_id}]")
            self._publish_map()

    def _is_new(self, base, time_ns):
        """Return whether the robot has moved since the last scan of the map."""
        if self._odometry is None:
            return True
        moved = _inverse(self._odometry).compose(base)
        is_late = time_ns - self._last_ns >= self._values["minimum_time_interval"] * 1e9
        is_far = np.hypot(moved.x, moved.y) >= self._values["minimum_travel_distance"]
        return bool(is_late and (is_far or abs(moved.yaw) >= self._values["minimum_travel_heading"]))

    def _broadcast(self):
        message, correction = TransformStamped(), self._correction
        tolerance = Duration(seconds=float(self._values["transform_timeout"]))
        message.header.stamp = (self.get_clock().now() + tolerance).to_msg()
        message.header.frame_id, message.child_frame_id = self._values["map_frame"], self._values["odom_frame"]
        message.transform.translation.x, message.transform.translation.y = correction.x, correction.y
        message.transform.rotation.z = float(np.sin(correction.yaw / 2))
        message.transform.rotation.w = float(np.cos(correction.yaw / 2))
        self._broadcaster.sendTransform(message)

    def _map(self):
        found, message = self._mapper.occupancy(), OccupancyGrid()
        message.header.frame_id = self._values["map_frame"]
        message.header.stamp = message.info.map_load_time = self.get_clock().now().to_msg()
        message.info.height, message.info.width = found.cells.shape
        message.info.resolution = found.resolution
        x, y, _ = found.origin.position
        message.info.origin.position.x, message.info.origin.position.y = float(x), float(y)
        message.info.origin.orientation.w = 1.0
        message.data = found.cells.reshape(-1).tolist()
        return message

    def _publish_map(self):
        if self._mapper.scans:
            self._publisher.publish(self._map())

    def _on_get_map(self, request, response):
        if self._mapper.scans:
            response.map = self._map()
        return response


def _planar(stamped):
    """Return the pose in the plane of a transform."""
    at, q = stamped.transform.translation, stamped.transform.rotation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
    return PlanarPose(at.x, at.y, float(yaw))


def _inverse(pose):
    cosine, sine = float(np.cos(pose.yaw)), float(np.sin(pose.yaw))
    x, y = -cosine * pose.x - sine * pose.y, sine * pose.x - cosine * pose.y
    return PlanarPose(x, y, -pose.yaw)


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    node = Slam()
    if not node.has_parameter("use_lifecycle_manager") or not node.get_parameter("use_lifecycle_manager").value:
        node.trigger_configure()
        node.trigger_activate()
    run(node)


if __name__ == "__main__":
    main()
