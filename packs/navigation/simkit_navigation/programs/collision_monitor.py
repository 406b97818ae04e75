"""Collision monitor of Nav2: changes velocities if points of laser scans are within zones around the robot."""

import ast
import math
import sys

import numpy as np
import rclpy
from geometry_msgs.msg import PolygonStamped, Twist, TwistStamped
from nav2_msgs.msg import CollisionMonitorState
from node_support import ServerNode, run, warn
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformException, TransformListener

from simkit_navigation.plugins.navigation.collision_zones import ACTIONS, CollisionZone, allowed_velocity
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

DEFAULTS = {
    "cmd_vel_in_topic": "cmd_vel_smoothed",
    "cmd_vel_out_topic": "cmd_vel",
    "state_topic": "",
    "base_frame_id": "base_footprint",
    "source_timeout": 2.0,
    "enable_stamped_cmd_vel": False,
}
"""Parameters and their defaults."""
STATES = {"stop": "STOP", "slowdown": "SLOWDOWN", "approach": "APPROACH", "limit": "LIMIT"}
NO_POINTS = np.zeros((0, 2))


class CollisionMonitor(ServerNode):
    """Node that passes velocities on while it is active."""

    def __init__(self):
        super().__init__("collision_monitor", automatically_declare_parameters_from_overrides=True)

    def _value(self, name, default):
        return self.get_parameter(name).value if self.has_parameter(name) else default

    def on_configure(self, state):
        """Read the zones and the sources, and open the topics."""
        super().on_configure(state)
        values = {name: self._value(name, default) for name, default in DEFAULTS.items()}
        self._base, self._timeout = values["base_frame_id"], float(values["source_timeout"])
        self._last_zone = " "
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._zones, self._scans = {}, {}
        self._opened = []
        left_out = [name for name in self._names("polygons") if not self._add_zone(name)]
        if left_out:
            warn(self, "SK-NAV-004", f"the polygons {', '.join(left_out)} are not checked: their type is not available")
        sources = [name for name in self._names("observation_sources") if self._value(f"{name}.enabled", True)]
        others = [name for name in sources if not self._add_source(name)]
        if others:
            warn(self, "SK-NAV-004", f"the sources {', '.join(others)} are left out; only laser scans are used")
        self._state = None
        if values["state_topic"]:
            self._state = self.create_publisher(CollisionMonitorState, values["state_topic"], 1)
        self._has_header = values["enable_stamped_cmd_vel"]
        kind = TwistStamped if self._has_header else Twist
        self._publisher = self.create_publisher(kind, values["cmd_vel_out_topic"], 1)
        self._opened.append(self.create_subscription(kind, values["cmd_vel_in_topic"], self._on_command, 1))
        return TransitionCallbackReturn.SUCCESS

    def _names(self, name):
        return [each for each in self._value(name, []) or [] if each]

    def _add_zone(self, name):
        """Read a zone; return False for a kind of zone that is not available."""

        def value(parameter, default):
            return self._value(f"{name}.{parameter}", default)

        kind, action = value("type", "polygon"), value("action_type", "none")
        if not value("enabled", True):
            return True
        if kind not in ("polygon", "circle") or action not in ACTIONS:
            return False
        corners = None if kind == "circle" else _corners(value("points", ""))
        topic = value("footprint_topic", "") or value("polygon_sub_topic", "")
        if corners is not None and not len(corners):
            if not topic:
                return False
            subscription = self.create_subscription(
                PolygonStamped, topic, lambda message: self._on_footprint(name, message), 1
            )
            self._opened.append(subscription)
        least = value("max_points", 3) + 1 if self.has_parameter(f"{name}.max_points") else value("min_points", 4)
        self._zones[name] = CollisionZone(
            name,
            action,
            corners,
            float(value("radius", 0.0)),
            int(least),
            float(value("slowdown_ratio", 0.5)),
            float(value("linear_limit", 0.5)),
            float(value("angular_limit", 0.5)),
            max(float(value("time_before_collision", 2.0)), 1e-3),
            max(float(value("simulation_time_step", 0.1)), 1e-3),
        )
        return True

    def _add_source(self, name):
        """Subscribe to a source; return False if it is no laser scan."""
        if self._value(f"{name}.type", "scan") != "scan":
            return False
        topic = self._value(f"{name}.topic", "scan")
        subscription = self.create_subscription(
            LaserScan, topic, lambda message: self._scans.update({name: message}), qos_profile_sensor_data
        )
        self._scans[name] = None
        self._opened.append(subscription)
        return True

    def on_cleanup(self, state):
        """Close the topics."""
        super().on_cleanup(state)
        self.destroy_publisher(self._publisher)
        for subscription in self._opened:
            self.destroy_subscription(subscription)
        return TransitionCallbackReturn.SUCCESS

    # ------------------------------------------------------------------ messages

    def _on_footprint(self, name, message):
        corners = np.array([(point.x, point.y) for point in message.polygon.points])
        pose = self._pose_of(message.header.frame_id, Time())
        if pose is not None and len(corners) >= 3:
            zone = self._zones[name]
            self._zones[name] = CollisionZone(**{**vars(zone), "corners": pose.transform(corners)})

    def _pose_of(self, frame, time):
        """Return the pose of a frame in that of the robot; None if it is not known."""
        if frame == self._base:
            return PlanarPose(0.0, 0.0, 0.0)
        try:
            found = self._buffer.lookup_transform(self._base, frame, time)
        except TransformException:
            return None
        at, q = found.transform.translation, found.transform.rotation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
        return PlanarPose(at.x, at.y, float(yaw))

    def _points(self):
        """Return the ends of the rays of all sources in the frame of the robot; None if a source is too old."""
        found = [NO_POINTS]
        now_ns = self.get_clock().now().nanoseconds
        for scan in self._scans.values():
            stamp = None if scan is None else Time.from_msg(scan.header.stamp)
            is_old = stamp is None or now_ns - stamp.nanoseconds > self._timeout * 1e9
            if is_old and self._timeout > 0:
                return None
            pose = None if scan is None else self._pose_of(scan.header.frame_id, Time())
            if pose is not None:
                ranges = np.asarray(scan.ranges, np.float64)
                angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
                is_hit = (ranges >= scan.range_min) & (ranges <= scan.range_max)
                ranges, angles = ranges[is_hit], angles[is_hit]
                found.append(pose.transform(np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))))
        return np.concatenate(found)

    def _on_command(self, message):
        if not self._is_active:
            return
        twist = message.twist if self._has_header else message
        wanted = (twist.linear.x, twist.linear.y, twist.angular.z)
        points = self._points() if self._zones else NO_POINTS
        if points is None:
            self._tell("stop", "invalid source", "a source has no new data")
            allowed = (0.0, 0.0, 0.0)
        else:
            allowed, zone = allowed_velocity(self._zones.values(), wanted, points)
            self._tell(*(("", "", "") if zone is None else (zone.action, zone.name, f"points in {zone.name}")))
        out = Twist()
        out.linear.x, out.linear.y, out.angular.z = map(float, allowed)
        self._publisher.publish(TwistStamped(header=message.header, twist=out) if self._has_header else out)

    def _tell(self, action, name, reason):
        """Log and publish a change of the zone that acts."""
        if f"{action} {name}" == self._last_zone:
            return
        self._last_zone = f"{action} {name}"
        if action:
            self.get_logger().info(f"Robot to {action} due to {reason}")
        else:
            self.get_logger().info("Robot to continue normal operation")
        if self._state is not None:
            number = getattr(CollisionMonitorState, STATES.get(action, "DO_NOTHING"))
            self._state.publish(CollisionMonitorState(action_type=number, polygon_name=name))


def _corners(points):
    """Return the corners in a text `[[x, y], …]`, or in a list of numbers as in Humble."""
    try:
        numbers = ast.literal_eval(points) if isinstance(points, str) and points else points or []
        return np.array(numbers, np.float64).reshape(-1, 2)
    except (ValueError, SyntaxError):
        return NO_POINTS


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(CollisionMonitor())


if __name__ == "__main__":
    main()
