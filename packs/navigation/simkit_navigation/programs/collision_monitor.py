"""Collision monitor of Nav2: changes velocities if points of obstacles are within zones around the robot."""

import math
import sys

import rclpy
from collision_sources import ZoneNode
from geometry_msgs.msg import Twist, TwistStamped
from nav2_msgs.msg import CollisionMonitorState
from node_support import run
from rclpy.lifecycle import TransitionCallbackReturn

from simkit_navigation.plugins.navigation.collision_zones import allowed_velocity

STATES = {"stop": "STOP", "slowdown": "SLOWDOWN", "approach": "APPROACH", "limit": "LIMIT"}
STANDING = (0.0, 0.0, 0.0)


class CollisionMonitor(ZoneNode):
    """Node that passes velocities on while it is active."""

    def __init__(self):
        super().__init__("collision_monitor")

    def on_configure(self, state):
        """Read the zones and the sources, and open the topics."""
        super().on_configure(state)
        self._last_zone, self._last, self._stopped_ns = " ", None, 0
        self._stop_timeout_ns = float(self.value("stop_pub_timeout", 1.0)) * 1e9
        self.configure_zones()
        topic = self.value("state_topic", "")
        self._state = self.create_publisher(CollisionMonitorState, topic, 1) if topic else None
        self._has_header = self.value("enable_stamped_cmd_vel", False)
        kind = TwistStamped if self._has_header else Twist
        self._publisher = self.create_publisher(kind, self.value("cmd_vel_out_topic", "cmd_vel"), 1)
        topic = self.value("cmd_vel_in_topic", "cmd_vel_smoothed")
        self._commands = self.create_subscription(kind, topic, self._on_command, 1)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        """Close the topics."""
        super().on_cleanup(state)
        self.close_zones()
        self.destroy_subscription(self._commands)
        self.destroy_publisher(self._publisher)
        if self._state is not None:
            self.destroy_publisher(self._state)
        return TransitionCallbackReturn.SUCCESS

    def _on_command(self, message):
        twist = message.twist if self._has_header else message
        wanted = (twist.linear.x, twist.linear.y, twist.angular.z)
        if not self._is_active or not all(map(math.isfinite, wanted)):
            return
        points = self.points_by_source()
        known = {name: found for name, found in points.items() if found is not None}
        self.publish_points(known)
        if any(found is None and self.is_required(name) for name, found in points.items()):
            self._tell("stop", "invalid source", "a source has no new data")
            allowed = STANDING
        else:
            zones = [zone.at_velocity(wanted) for zone in self.zones.values()]
            allowed, zone = allowed_velocity(zones, wanted, known)
            self._tell(*(("", "", "") if zone is None else (zone.action, zone.name, f"points in {zone.name}")))
        self.publish_zones(wanted)
        self._send(allowed, message)

    def _send(self, velocity, message):
        """Publish a velocity; a robot that stands gets no more commands after `stop_pub_timeout`, as in Nav2."""
        now = self.get_clock().now().nanoseconds
        is_standing = velocity == STANDING
        if is_standing and self._last != STANDING:
            self._stopped_ns = now
        self._last = velocity
        if is_standing and now - self._stopped_ns > self._stop_timeout_ns:
            return
        out = Twist()
        out.linear.x, out.linear.y, out.angular.z = map(float, velocity)
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


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(CollisionMonitor())


if __name__ == "__main__":
    main()
