"""Pose graph as markers, and its nodes as interactive markers that a user moves by hand."""

import math

import numpy as np
from geometry_msgs.msg import Point, TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import LaserScan
from slam_toolbox.srv import Clear, LoopClosure, ToggleInteractive
from tf2_ros import TransformBroadcaster
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerFeedback,
    InteractiveMarkerInit,
    InteractiveMarkerUpdate,
    Marker,
    MarkerArray,
)
from visualization_msgs.srv import GetInteractiveMarkers

from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, yaw_of

EDGES = {False: ((0.0, 0.0, 1.0), 0), True: ((0.0, 1.0, 1.0), 1)}
"""Colour and number of the lines of edges; those of loops are apart."""
HALF = math.sqrt(0.5)


class GraphMarkers:
    """Topics and services of the graph of a node.

    Nodes are moved through the topics of an interactive marker server. `manual_loop_closure` optimises the graph from
    the new poses, and `clear_changes` forgets them.
    """

    def __init__(self, node, frame, is_interactive):
        self._node, self._frame = node, frame
        self._can_move = self._is_interactive = is_interactive
        self._moved, self._mapper, self._sequence = {}, None, 0
        self._publisher = node.create_publisher(MarkerArray, "slam_toolbox/graph_visualization", 1)
        self._scans = node.create_publisher(LaserScan, "slam_toolbox/scan_visualization", 10)
        node.create_service(Clear, "slam_toolbox/clear_changes", self._on_clear)
        node.create_service(LoopClosure, "slam_toolbox/manual_loop_closure", self._on_close)
        node.create_service(ToggleInteractive, "slam_toolbox/toggle_interactive_mode", self._on_toggle)
        if self._can_move:
            self._broadcaster = TransformBroadcaster(node)
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._initial = node.create_publisher(InteractiveMarkerInit, "slam_toolbox/update_full", latched)
            self._updates = node.create_publisher(InteractiveMarkerUpdate, "slam_toolbox/update", 100)
            node.create_service(GetInteractiveMarkers, "slam_toolbox/get_interactive_markers", self._on_get)
            node.create_subscription(InteractiveMarkerFeedback, "slam_toolbox/feedback", self._on_feedback, 10)

    def publish(self, mapper):
        """Publish the graph of a mapper."""
        self._mapper = mapper
        nodes = [self._sphere(index, scan.pose) for index, scan in enumerate(mapper.scans)]
        is_moving = self._can_move and self._is_interactive
        markers = [Marker(action=Marker.DELETEALL), *([] if is_moving else nodes), *self._lines(mapper)]
        self._publisher.publish(MarkerArray(markers=markers))
        if self._can_move:
            self._publish_interactive()

    def clear(self):
        """Forget the nodes that were moved."""
        self._moved = {}

    def _sphere(self, index, pose):
        marker = self._marker("slam_toolbox", index, Marker.SPHERE, 0.1, (1.0, 0.0, 0.0))
        marker.scale.y = marker.scale.z = 0.1
        marker.pose.position.x, marker.pose.position.y = pose.x, pose.y
        return marker

    def _lines(self, mapper):
        lines = []
        for is_loop, (colour, number) in EDGES.items():
            marker = self._marker("slam_toolbox_edges", number, Marker.LINE_LIST, 0.05, colour)
            for edge in mapper.edges:
                if edge.is_loop == is_loop:
                    ends = (mapper.scans[edge.first].pose, mapper.scans[edge.second].pose)
                    marker.points += [Point(x=pose.x, y=pose.y) for pose in ends]
            lines.append(marker)
        return [line for line in lines if line.points]

    def _marker(self, space, number, kind, size, colour):
        marker = Marker(ns=space, id=number, type=kind, action=Marker.ADD)
        marker.header.frame_id, marker.header.stamp = self._frame, self._node.get_clock().now().to_msg()
        marker.pose.orientation.w, marker.scale.x = 1.0, size
        marker.color.r, marker.color.g, marker.color.b = colour
        marker.color.a = 1.0
        return marker

    # ------------------------------------------------------------------ nodes moved by hand

    def _interactive(self):
        markers = []
        for index, scan in enumerate(self._mapper.scans if self._is_interactive and self._mapper else ()):
            pose = self._moved.get(index, scan.pose)
            marker = InteractiveMarker(name=str(index), scale=0.3)
            marker.header.frame_id = self._frame
            marker.pose.position.x, marker.pose.position.y, marker.pose.orientation.w = pose.x, pose.y, 1.0
            sphere = self._sphere(index, PlanarPose(0.0, 0.0, 0.0))
            sphere.header.frame_id = ""  # in the frame of the interactive marker
            plane = InteractiveMarkerControl(
                name="move",
                orientation_mode=InteractiveMarkerControl.FIXED,
                interaction_mode=InteractiveMarkerControl.MOVE_PLANE,
                always_visible=True,
                markers=[sphere],
            )
            turn = InteractiveMarkerControl(name="turn", interaction_mode=InteractiveMarkerControl.ROTATE_AXIS)
            for control in (plane, turn):  # the x axis of a control points up
                control.orientation.w, control.orientation.y = HALF, HALF
            marker.controls = [plane, turn]
            markers.append(marker)
        return markers

    def _publish_interactive(self):
        self._sequence += 1
        markers = self._interactive()
        self._initial.publish(InteractiveMarkerInit(server_id="/slam_toolbox", seq_num=self._sequence, markers=markers))
        update = InteractiveMarkerUpdate(server_id="/slam_toolbox", seq_num=self._sequence, markers=markers)
        update.type = InteractiveMarkerUpdate.UPDATE
        if not self._is_interactive and self._mapper:
            update.erases = [str(index) for index in range(len(self._mapper.scans))]
        self._updates.publish(update)

    def _on_get(self, request, response):
        response.sequence_number, response.markers = self._sequence, self._interactive()
        return response

    def _on_feedback(self, message):
        is_number = message.marker_name.isdecimal() and self._mapper is not None
        if not self._is_interactive or not is_number or int(message.marker_name) >= len(self._mapper.scans):
            return
        index = int(message.marker_name)
        scan = self._mapper.scans[index]
        turn = yaw_of(message.pose.orientation)
        x, y = message.pose.position.x, message.pose.position.y
        if not all(map(math.isfinite, (x, y, turn))):
            return
        pose = PlanarPose(x, y, math.remainder(scan.pose.yaw + turn, math.tau))
        if message.event_type == InteractiveMarkerFeedback.MOUSE_UP:
            self._moved[index] = pose
        elif message.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
            self._show_scan(scan, pose.compose(scan.sensor))

    def _show_scan(self, scan, pose):
        """Publish a scan at a pose of its sensor while a user moves it."""
        place, stamp = TransformStamped(), self._node.get_clock().now().to_msg()
        place.header.frame_id, place.header.stamp, place.child_frame_id = self._frame, stamp, "scan_visualization"
        set_pose(place.transform.translation, place.transform.rotation, pose)
        self._broadcaster.sendTransform(place)
        message = LaserScan(range_max=scan.limit, ranges=np.where(scan.is_hit, scan.ranges, np.inf).tolist())
        message.header.frame_id, message.header.stamp = "scan_visualization", stamp
        if len(scan.angles):
            message.angle_min, message.angle_max = float(scan.angles[0]), float(scan.angles[-1])
            message.angle_increment = (message.angle_max - message.angle_min) / max(len(scan.angles) - 1, 1)
        self._scans.publish(message)

    def _on_clear(self, request, response):
        self._node.get_logger().info("LoopClosureAssistant: Clearing manual loop closure nodes.")
        self.clear()
        return response

    def _on_close(self, request, response):
        if self._moved:
            self._node.mapper.move(self._moved)
            self._node.get_logger().info(f"the graph is optimised from {len(self._moved)} moved nodes")
        self.clear()
        return response

    def _on_toggle(self, request, response):
        if not self._can_move:
            self._node.get_logger().warning(
                "Called toggle interactive mode with interactive mode disabled: set enable_interactive_mode. Ignoring."
            )
            return response
        self._is_interactive = not self._is_interactive
        state = "interactive" if self._is_interactive else "autonomous"
        self._node.get_logger().info(f"SlamToolbox: Toggling {state} mode.")
        if self._mapper is not None:
            self.publish(self._mapper)
        return response


def set_pose(place, turn, pose):
    """Set the position and the quaternion of a message to a pose in the plane."""
    place.x, place.y = pose.x, pose.y
    turn.z, turn.w = math.sin(pose.yaw / 2), math.cos(pose.yaw / 2)
