"""Nodes `imu_filter_madgwick` and `imu_complementary_filter`: orientation from the measurements of an IMU."""

import sys

import numpy as np
import rclpy
from geometry_msgs.msg import TransformStamped, Vector3Stamped
from node_support import run, warn
from rclpy.node import Node
from sensor_msgs.msg import Imu, MagneticField
from tf2_ros import TransformBroadcaster
from tf_transformations import euler_from_quaternion

from simkit.pose import quat_multiply
from simkit_navigation.orientation_filters import WORLD_FRAMES, ComplementaryFilter, MadgwickFilter
from simkit_nodes.host import current_host
from simkit_nodes.ros1_parameters import parameter_server

MADGWICK = {
    "gain": 0.1,
    "zeta": 0.0,
    "mag_bias_x": 0.0,
    "mag_bias_y": 0.0,
    "mag_bias_z": 0.0,
    "orientation_stddev": 0.0,
    "use_mag": True,
    "world_frame": "enu",
    "publish_tf": True,
    "reverse_tf": False,
    "fixed_frame": "odom",
    "constant_dt": 0.0,
    "stateless": False,
    "remove_gravity_vector": False,
    "publish_debug_topics": False,
}
COMPLEMENTARY = {
    "gain_acc": 0.01,
    "gain_mag": 0.01,
    "bias_alpha": 0.01,
    "do_bias_estimation": True,
    "do_adaptive_gain": False,
    "use_mag": False,
    "publish_tf": False,
    "reverse_tf": False,
    "fixed_frame": "odom",
    "constant_dt": 0.0,
    "publish_debug_topics": False,
    "orientation_stddev": 0.0,
}
"""Parameters and their defaults."""
LONGEST = 10.0  # [s] without a magnetic field before a warning


class ImuFilter(Node):
    """Node that adds an orientation to the messages of an IMU."""

    def __init__(self, is_madgwick):
        super().__init__("imu_filter" if is_madgwick else "complementary_filter_node")
        self._v = {
            name: self._value(name, value) for name, value in (MADGWICK if is_madgwick else COMPLEMENTARY).items()
        }
        v, frame = self._v, self._v.get("world_frame", "enu")
        if frame not in WORLD_FRAMES:
            self.get_logger().error(f"the parameter world_frame is {frame!r}; expected enu, nwu or ned")
            sys.exit(1)
        unused = [name for name in ("stateless", "remove_gravity_vector", "do_adaptive_gain") if v.get(name)]
        if unused:
            warn(self, "SK-NAV-002", f"no effect here: {', '.join(unused)}")
        self._frame = WORLD_FRAMES[frame]
        if is_madgwick:
            self._filter = MadgwickFilter(v["gain"], v["zeta"])
        else:
            bias = v["bias_alpha"] if v["do_bias_estimation"] else 0.0
            self._filter = ComplementaryFilter(v["gain_acc"], v["gain_mag"], bias)
        self._field = self._last_ns = None
        self._bias = np.array([v.get(f"mag_bias_{axis}", 0.0) for axis in "xyz"])
        self._broadcaster = TransformBroadcaster(self)
        self._out = self.create_publisher(Imu, "imu/data", 5)
        self._rpy = self.create_publisher(Vector3Stamped, "imu/rpy/filtered", 5) if v["publish_debug_topics"] else None
        self.create_subscription(Imu, "imu/data_raw", self._take, 5)
        if v["use_mag"]:
            self.create_subscription(MagneticField, "imu/mag", self._take_field, 5)
            self._timer = self.create_timer(LONGEST, self._tell)

    def _value(self, name, default):
        """Return a parameter, in ROS 1 that of the parameter server."""
        server, own = parameter_server(current_host()), f"{self.get_fully_qualified_name()}/{name}"
        if server.has(own):
            default = type(default)(server.get(own))
        return self.declare_parameter(name, default).value

    def _tell(self):
        self._timer.cancel()
        if self._field is None:
            self.get_logger().warning("Still waiting for data on topics imu/data_raw and imu/mag...")

    def _take_field(self, message):
        m = message.magnetic_field
        self._field = np.array([m.x, m.y, m.z]) - self._bias

    def _take(self, message):
        if self._v["use_mag"] and self._field is None:
            return
        stamp = message.header.stamp
        now = stamp.sec * 1_000_000_000 + stamp.nanosec
        step = self._v["constant_dt"] or (0.0 if self._last_ns is None else max(now - self._last_ns, 0) * 1e-9)
        self._last_ns = now
        rate, force = message.angular_velocity, message.linear_acceleration
        rates, forces = np.array([rate.x, rate.y, rate.z]), np.array([force.x, force.y, force.z])
        q = quat_multiply(self._frame, self._filter.update(rates, forces, self._field, step))
        turn = message.orientation
        turn.w, turn.x, turn.y, turn.z = (float(value) for value in q)
        spread = float(self._v["orientation_stddev"]) ** 2
        message.orientation_covariance = [spread, 0.0, 0.0, 0.0, spread, 0.0, 0.0, 0.0, spread]
        self._out.publish(message)
        if self._rpy is not None:
            angles = Vector3Stamped(header=message.header)
            angles.vector.x, angles.vector.y, angles.vector.z = euler_from_quaternion([turn.x, turn.y, turn.z, turn.w])
            self._rpy.publish(angles)
        if self._v["publish_tf"]:
            self._send_transform(message)

    def _send_transform(self, message):
        transform = TransformStamped(header=message.header, child_frame_id=message.header.frame_id)
        transform.header.frame_id, turn = self._v["fixed_frame"], message.orientation
        sign = 1.0
        if self._v["reverse_tf"]:
            transform.header.frame_id, transform.child_frame_id = transform.child_frame_id, transform.header.frame_id
            sign = -1.0
        rotation = transform.transform.rotation
        rotation.w, rotation.x, rotation.y, rotation.z = turn.w, sign * turn.x, sign * turn.y, sign * turn.z
        self._broadcaster.sendTransform(transform)


def main():
    """Run the node."""
    rclpy.init()
    run(ImuFilter("madgwick" in sys.argv[0]))


if __name__ == "__main__":
    main()
