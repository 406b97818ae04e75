"""Nodes of slam_toolbox: mapping, lifelong mapping and localization. They replace gmapping and cartographer, too."""

import math
import sys
from pathlib import Path

import numpy as np
import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from node_support import run, warn
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from slam_graph_markers import GraphMarkers, set_pose
from slam_parameters import MISSING_OF_OTHERS, settings_of, values_of
from slam_toolbox.srv import DeserializePoseGraph, Pause, Reset, SaveMap, SerializePoseGraph
from std_srvs.srv import Empty, SetBool
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

from simkit_navigation.plugins.maps.map_saver import MapNotSaved, write_map
from simkit_navigation.plugins.maps.pose_graph_file import PoseGraphFault, read_pose_graph, write_pose_graph
from simkit_navigation.plugins.maps.scan_mapper import MapScan, ScanMapper
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, yaw_of
from simkit_navigation.plugins.navigation.robot_link import links_of_frame
from simkit_nodes.host import current_host

THRESHOLDS = (0.25, 0.65)
"""Occupancies of free and of occupied cells in the files of `save_map`, as in `map_saver_cli`."""
MATCH_TYPES = DeserializePoseGraph.Request
LONGEST_WAIT = Duration(seconds=2.0)
"""Time without the transforms of a scan after which a warning tells this."""
LOCALIZATION, MAPPING = "localization", "mapping"


class Slam(LifecycleNode):
    """Node that makes a map, or localises in a stored one, from its start on, whatever its state."""

    def __init__(self):
        executable = sys.argv[0].partition("/")[2]
        is_other = sys.argv[0] in MISSING_OF_OTHERS
        name = executable if is_other else "slam_toolbox"
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        self._values = values = values_of(self, sys.argv[0])
        self._can_switch = "map_and_localization" in executable or "MapAndLocalization" in executable
        is_localization = executable.startswith(LOCALIZATION) or executable.endswith("::LocalizationSlamToolbox")
        self._mode = LOCALIZATION if is_localization else MAPPING
        if self._can_switch:
            self._mode = LOCALIZATION if values["localization_on_configure"] else MAPPING
        self._tell_differences(executable, is_other)
        self._mapper = ScanMapper(settings_of(values))
        self._correction = PlanarPose(0.0, 0.0, 0.0)  # pose of the odometry in the map
        self._start = PlanarPose(*values["map_start_pose"]) if values["map_start_pose"] else None  # of the next scan
        if self._start is None and executable == "cartographer_node":
            self._start = PlanarPose(0.0, 0.0, 0.0)  # its map begins at the robot; those of the others at the odometry
        self._is_far = False  # the start is only about right
        self._odometry = None  # pose of the robot in the odometry at the last scan that was used
        self._pending, self._last_ns, self._count = [], None, 0
        self._waits_since, self._has_told_wait = None, False
        self._is_paused = values["paused_new_measurements"]
        self._buffer = Buffer(cache_time=Duration(seconds=values["tf_buffer_duration"]))
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = TransformBroadcaster(self)
        self._open_topics()
        self._open_services(is_other)
        self._markers = GraphMarkers(
            self, values["map_frame"], values["enable_interactive_mode"] and not is_localization
        )
        if values["map_file_name"]:
            self._load_at_start()

    def on_configure(self, state):
        """Do nothing: the node works from its start."""
        return TransitionCallbackReturn.SUCCESS

    def _tell_differences(self, executable, is_other):
        if is_other:
            missing = MISSING_OF_OTHERS[sys.argv[0]]
            warn(self, "SK-NAV-001", f"the mapper of slam_toolbox replaces {executable}: {missing}")
        if executable.startswith("lifelong") or "Lifelong" in executable:
            warn(self, "SK-NAV-001", "scans are added as in mapping; none is removed from the graph")
        if self._mode == LOCALIZATION and not self._values["map_file_name"]:
            warn(self, "SK-NAV-001", "map_file_name is empty: a new map is made until deserialize_map is called")
        if self._values["mode"] == LOCALIZATION and self._mode == MAPPING and not is_other:
            text = "mode: localization has no effect, as in slam_toolbox: start localization_slam_toolbox_node"
            warn(self, "SK-NAV-001", text)

    def _open_topics(self):
        values = self._values
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._publisher = self.create_publisher(OccupancyGrid, values["map_name"], latched)
        self._metadata = self.create_publisher(MapMetaData, f"{values['map_name']}_metadata", latched)
        self._poses = self.create_publisher(PoseWithCovarianceStamped, "pose", 10)
        self.create_subscription(LaserScan, values["scan_topic"], self._on_scan, qos_profile_sensor_data)
        if self._mode == LOCALIZATION or self._can_switch:
            self.create_subscription(PoseWithCovarianceStamped, "initialpose", self._on_initial_pose, 1)
        self.create_timer(max(values["transform_publish_period"], 0.01), self._on_timer)
        self.create_timer(max(values["map_update_interval"], 0.1), self._publish_map)

    def _open_services(self, is_other):
        self.create_service(GetMap, "~/dynamic_map" if is_other else "slam_toolbox/dynamic_map", self._on_get_map)
        if is_other:
            return
        if self._values["use_map_saver"]:
            self.create_service(SaveMap, "slam_toolbox/save_map", self._on_save_map)
        self.create_service(SerializePoseGraph, "slam_toolbox/serialize_map", self._on_serialize)
        self.create_service(DeserializePoseGraph, "slam_toolbox/deserialize_map", self._on_deserialize)
        self.create_service(Pause, "slam_toolbox/pause_new_measurements", self._on_pause)
        self.create_service(Reset, "slam_toolbox/reset", self._on_reset)
        if self._mode == LOCALIZATION or self._can_switch:
            self.create_service(Empty, "slam_toolbox/clear_localization_buffer", self._on_clear_buffer)
        if self._can_switch:
            self.create_service(SetBool, "slam_toolbox/set_localization_mode", self._on_set_mode)

    # ------------------------------------------------------------------ scans

    def _on_scan(self, scan):
        self._count += 1
        if self._count == 1 or self._count % self._values["throttle_scans"] == 0:
            self._pending = [*self._pending, scan][-self._values["scan_queue_size"] :]

    def _on_timer(self):
        while self._pending and self._use_if_known(self._pending[0]):
            self._pending.pop(0)
        if self._odometry is not None and self._values["transform_publish_period"] > 0.0:
            self._broadcast()

    def _use_if_known(self, scan):
        """Use a scan as soon as its transforms are known; return whether they are."""
        values, stamp = self._values, Time.from_msg(scan.header.stamp)
        if not self._is_due(stamp.nanoseconds):
            return True
        try:
            base = _planar(self._buffer.lookup_transform(values["odom_frame"], values["base_frame"], stamp))[0]
            if not self._has_moved(base):
                return True
            transform = self._buffer.lookup_transform(values["base_frame"], scan.header.frame_id, stamp)
        except TransformException as error:
            self._tell_waiting(scan, error)
            return False
        sensor, is_inverted = _planar(transform)
        if self._odometry is None:
            self.get_logger().info(f"Registering sensor: [{scan.header.frame_id}]")
        ranges = np.asarray(scan.ranges, np.float64)
        ranges = np.where(ranges < scan.range_min, np.nan, ranges)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        guess = self._correction.compose(base)
        if self._odometry is None and self._start is None and values["begin_at_true_pose"]:
            self._start = self._true_pose()
        if self._start is not None:
            guess, self._start = self._start, None
        measured = MapScan(ranges, -angles if is_inverted else angles, float(scan.range_max), sensor, base, guess)
        is_first = not self._mapper.scans
        loops = self._mapper.loops
        pose = self._used(measured)
        if self._mapper.loops > loops:
            self.get_logger().info(f"Loop closed: {len(self._mapper.scans)} scans, {self._mapper.loops} loops")
        self._correction = pose.compose(base.inverse())
        self._odometry, self._last_ns = base, stamp.nanoseconds
        self._publish_pose(pose, scan.header.stamp)
        if is_first:
            self._publish_map()
        return True

    def _tell_waiting(self, scan, error):
        """Warn once if no scan has been used within LONGEST_WAIT, because a transform is missing."""
        now = self.get_clock().now()
        self._waits_since = self._waits_since or now
        has_waited = now - self._waits_since > LONGEST_WAIT
        if self._odometry is None and has_waited and not self._has_told_wait:
            self._has_told_wait = True
            warn(self, "SK-SLAM-003", f"no scan of the frame {scan.header.frame_id!r:.100} is used: {error}")

    def _true_pose(self):
        """Return the true pose of the robot in the world, so that the map has the frame of the world."""
        simulation, frame = current_host().simulation, self._values["base_frame"]
        links = [] if simulation is None else links_of_frame(simulation, frame)
        if len(links) != 1:
            warn(self, "SK-NAV-001", f"{len(links)} models have a link {frame!r}: the map begins at the odometry")
            return None
        pose = links[0].pose
        return PlanarPose(float(pose.position[0]), float(pose.position[1]), float(pose.rpy[2]))

    def _used(self, scan):
        """Match a scan, add it in mapping, and return the pose of the robot in the map."""
        is_far, self._is_far = self._is_far and bool(self._mapper.scans), False
        if self._mode == LOCALIZATION and self._mapper.scans and self._has_stored_map:
            return self._mapper.localise(scan, is_far)
        return self._mapper.add_far_scan(scan) if is_far else self._mapper.add_scan(scan)

    _has_stored_map = False

    def _is_due(self, time_ns):
        """Return whether enough time has passed since the last scan that was used, and scans are used at all."""
        if self._odometry is None or self._is_far:
            return True
        return not self._is_paused and time_ns - self._last_ns >= self._values["minimum_time_interval"] * 1e9

    def _has_moved(self, base):
        """Return whether the robot has moved enough since the last scan that was used."""
        if self._odometry is None or self._is_far:
            return True
        moved = self._odometry.inverse().compose(base)
        is_far = math.hypot(moved.x, moved.y) >= self._values["minimum_travel_distance"]
        return is_far or abs(moved.yaw) >= self._values["minimum_travel_heading"]

    def _on_initial_pose(self, message):
        if self._mode != LOCALIZATION:
            self.get_logger().error("a pose on initialpose is used only in localization mode")
            return
        pose = message.pose.pose
        self._begin_at(PlanarPose(pose.position.x, pose.position.y, yaw_of(pose.orientation)))
        self.get_logger().info(f"Localizing to: ({pose.position.x:.2f} {pose.position.y:.2f})")

    def _begin_at(self, pose):
        self._start, self._is_far = pose, True

    # ------------------------------------------------------------------ output

    def _broadcast(self):
        message = TransformStamped()
        tolerance = Duration(seconds=self._values["transform_timeout"])
        message.header.stamp = (self.get_clock().now() + tolerance).to_msg()
        message.header.frame_id, message.child_frame_id = self._values["map_frame"], self._values["odom_frame"]
        set_pose(message.transform.translation, message.transform.rotation, self._correction)
        self._broadcaster.sendTransform(message)

    def _publish_pose(self, pose, stamp):
        message, values = PoseWithCovarianceStamped(), self._values
        message.header.frame_id, message.header.stamp = values["map_frame"], stamp
        set_pose(message.pose.pose.position, message.pose.pose.orientation, pose)
        xx, xy, yy, yaw = self._mapper.covariance
        covariance, scale = [0.0] * 36, values["position_covariance_scale"]
        covariance[0], covariance[1], covariance[6], covariance[7] = xx * scale, xy * scale, xy * scale, yy * scale
        covariance[35] = yaw * values["yaw_covariance_scale"]
        message.pose.covariance = covariance
        self._poses.publish(message)

    def _map(self):
        occupancy, message = self._mapper.occupancy(), OccupancyGrid()
        message.header.frame_id = self._values["map_frame"]
        message.header.stamp = message.info.map_load_time = self.get_clock().now().to_msg()
        message.info.height, message.info.width = occupancy.cells.shape
        message.info.resolution = occupancy.resolution
        x, y, _ = occupancy.origin.position
        message.info.origin.position.x, message.info.origin.position.y = float(x), float(y)
        message.info.origin.orientation.w = 1.0
        message.data = occupancy.cells.reshape(-1).tolist()
        return message

    def _publish_map(self):
        if self._mapper.scans:
            message = self._map()
            self._publisher.publish(message)
            self._metadata.publish(message.info)
            self._markers.publish(self._mapper)

    # ------------------------------------------------------------------ services

    def _on_get_map(self, request, response):
        if self._mapper.scans:
            response.map = self._map()
        return response

    def _on_save_map(self, request, response):
        if not self._mapper.scans:
            self.get_logger().warning("Map Saver: Cannot save map, no map yet received")
            response.result = SaveMap.Response.RESULT_NO_MAP_RECEIEVD
            return response
        stem = Path(request.name.data or "map").expanduser().absolute()
        try:
            file = write_map(self._map(), stem, "trinary", "pgm", THRESHOLDS)
        except (MapNotSaved, OSError) as error:
            self.get_logger().error(f"Failed to save the map: {error}")
            response.result = SaveMap.Response.RESULT_UNDEFINED_FAILURE
            return response
        self.get_logger().info(f"Map saved successfully: {file}")
        response.result = SaveMap.Response.RESULT_SUCCESS
        return response

    def _on_serialize(self, request, response):
        response.result = SerializePoseGraph.Response.RESULT_FAILED_TO_WRITE_FILE
        if self._mode == LOCALIZATION:
            self.get_logger().error("Cannot call serialize map in localization mode!")
            return response
        try:
            file = write_pose_graph(request.filename, self._mapper.scans, self._mapper.edges)
        except (PoseGraphFault, OSError) as error:
            self.get_logger().error(f"Failed to write the pose graph: {error}")
            return response
        self.get_logger().info(f"Pose graph written: {file}")
        response.result = SerializePoseGraph.Response.RESULT_SUCCESS
        return response

    def _on_deserialize(self, request, response):
        if request.match_type not in (
            MATCH_TYPES.START_AT_FIRST_NODE,
            MATCH_TYPES.START_AT_GIVEN_POSE,
            MATCH_TYPES.LOCALIZE_AT_POSE,
        ):
            self.get_logger().error(f"match_type {request.match_type} is not 1, 2 or 3: the pose graph is not read")
        elif (request.match_type == MATCH_TYPES.LOCALIZE_AT_POSE) != (self._mode == LOCALIZATION):
            self.get_logger().error(f"match_type {request.match_type} is not possible in {self._mode} mode")
        else:
            at = request.initial_pose
            is_first = request.match_type == MATCH_TYPES.START_AT_FIRST_NODE
            try:
                self._load(request.filename, None if is_first else PlanarPose(at.x, at.y, at.theta))
            except PoseGraphFault as error:
                self.get_logger().error(f"Failed to read the pose graph: {error}")
        return response

    def _load_at_start(self):
        """Load the pose graph of the parameters; a given pose counts more than the first node, as in slam_toolbox."""
        values, start = self._values, self._start
        if start is None and (not values["map_start_at_dock"] or self._mode == LOCALIZATION):
            start = PlanarPose(0.0, 0.0, 0.0)
        try:
            self._load(values["map_file_name"], start)
        except PoseGraphFault as error:
            warn(self, "SK-SLAM-002", f"map_file_name: {error}")

    def _load(self, name, start):
        """Replace the map; the robot is near a pose, or near the first node for None."""
        scans, edges = read_pose_graph(name)
        if not scans:
            raise PoseGraphFault(f"the pose graph {name!r} has no scans")
        self._mapper.restore(scans, edges)
        self._has_stored_map = True
        self._begin_at(start or scans[0].pose)
        self.get_logger().info(f"Pose graph read: {len(scans)} scans, {len(edges)} edges")
        self._publish_map()

    def _on_pause(self, request, response):
        self._set_paused(not self._is_paused)
        response.status = True
        return response

    def _set_paused(self, is_paused):
        self._is_paused = is_paused
        self.set_parameters([Parameter("paused_new_measurements", Parameter.Type.BOOL, is_paused)])
        state = "pause taking new measurements" if is_paused else "actively taking new measurements"
        self.get_logger().info(f"SlamToolbox: Toggled to {state}.")

    def _on_reset(self, request, response):
        self._mapper = ScanMapper(self._mapper.settings)
        self._correction, self._odometry, self._has_stored_map = PlanarPose(0.0, 0.0, 0.0), None, False
        self._pending, self._start, self._is_far = [], None, False
        self._set_paused(bool(request.pause_new_measurements))
        self._markers.clear()
        response.result = Reset.Response.RESULT_SUCCESS
        return response

    def _on_clear_buffer(self, request, response):
        self.get_logger().info("the localization adds no scans to the map: there is no buffer to clear")
        return response

    def _on_set_mode(self, request, response):
        self._mode = LOCALIZATION if request.data else MAPPING
        self._has_stored_map = bool(self._mapper.scans)
        self.get_logger().info(f"Enabling {self._mode} ...")
        response.success = True
        return response

    @property
    def mapper(self):
        """Map and graph."""
        return self._mapper


def _planar(stamped):
    """Return the pose in the plane of a transform, and whether its z axis points down."""
    at, q = stamped.transform.translation, stamped.transform.rotation
    return PlanarPose(at.x, at.y, yaw_of(q)), q.x**2 + q.y**2 > q.z**2 + q.w**2


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    node = Slam()
    if not node.get_parameter("use_lifecycle_manager").value:
        node.trigger_configure()
        node.trigger_activate()
    run(node)


if __name__ == "__main__":
    main()
