"""Node `navsat_transform_node` of robot_localization: satellite positions in the frame of the odometry."""

import math
import sys

import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from node_support import run
from rclpy.node import Node
from rclpy.time import Time
from robot_localization.srv import FromLL, SetDatum, ToLL
from sensor_msgs.msg import Imu, NavSatFix, NavSatStatus
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformException, TransformListener

from simkit_navigation.plugins.localisation.utm_projection import UtmZone
from simkit_navigation.plugins.navigation.planar_pose import yaw_of

DEFAULTS = {
    "frequency": 10.0,
    "magnetic_declination_radians": 0.0,
    "yaw_offset": 0.0,
    "zero_altitude": False,
    "publish_filtered_gps": False,
    "broadcast_utm_transform": False,
    "broadcast_cartesian_transform": False,
    "broadcast_utm_transform_as_parent_frame": False,
    "broadcast_cartesian_transform_as_parent_frame": False,
    "use_odometry_yaw": False,
    "wait_for_datum": False,
    "delay": 0.0,
    "base_link_frame": "base_link",
    "world_frame": "odom",
}
"""Parameters and their defaults."""


class NavSatTransform(Node):
    """Node with the topic `odometry/gps` and the services `datum`, `toLL` and `fromLL`."""

    def __init__(self):
        super().__init__("navsat_transform_node", automatically_declare_parameters_from_overrides=True)
        for name, value in DEFAULTS.items():
            if not self.has_parameter(name):
                self.declare_parameter(name, value)
        self._values = {name: self.get_parameter(name).value for name in DEFAULTS}
        self._zone = None
        self._rotation = (1.0, 0.0)  # cosine and sine of the angle from the grid to the world frame
        self._shift = (0.0, 0.0, 0.0)  # from the rotated grid to the world frame [m]
        self._world_frame, self._base_frame = self._values["world_frame"], self._values["base_link_frame"]
        self._yaw = self._odometry = self._fix = None
        self._is_known = False
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._broadcaster = StaticTransformBroadcaster(self)
        self._gps = self.create_publisher(Odometry, "odometry/gps", 10)
        self._filtered = None
        if self._values["publish_filtered_gps"]:
            self._filtered = self.create_publisher(NavSatFix, "gps/filtered", 10)
        self.create_subscription(NavSatFix, "gps/fix", self._on_fix, 10)
        self.create_subscription(Odometry, "odometry/filtered", self._on_odometry, 10)
        if not self._values["use_odometry_yaw"] and not self._values["wait_for_datum"]:
            self.create_subscription(Imu, "imu", self._on_imu, 10)
        self.create_service(SetDatum, "datum", self._on_datum)
        self.create_service(ToLL, "toLL", self._on_to_ll)
        self.create_service(FromLL, "fromLL", self._on_from_ll)
        datum = list(self.get_parameter("datum").value or []) if self.has_parameter("datum") else []
        self._datum = [float(value) for value in datum[:3]] if self._values["wait_for_datum"] else None
        self.create_timer(1.0 / float(self._values["frequency"]), self._on_timer)

    # ------------------------------------------------------------------ messages

    def _on_imu(self, message):
        self._yaw = yaw_of(message.orientation)

    def _on_odometry(self, message):
        self._odometry = message
        self._world_frame, self._base_frame = message.header.frame_id, message.child_frame_id
        if self._values["use_odometry_yaw"]:
            self._yaw = yaw_of(message.pose.pose.orientation)

    def _on_fix(self, message):
        is_valid = message.status.status != NavSatStatus.STATUS_NO_FIX and all(
            math.isfinite(value) for value in (message.latitude, message.longitude, message.altitude)
        )
        if is_valid:
            self._fix = message

    def _on_timer(self):
        if not self._is_known:
            self._find_transform()
        if not self._is_known:
            return
        if self._fix is not None:
            fix, self._fix = self._fix, None
            self._publish(fix)
        if self._filtered is not None and self._odometry is not None:
            self._publish_filtered(self._odometry)

    # ------------------------------------------------------------------ transform

    def _find_transform(self):
        """Find the world frame in the grid, from the first position, the heading and the odometry."""
        if self._datum:
            latitude, longitude, heading, *_ = (*self._datum, 0.0, 0.0, 0.0)
            self._set_origin(latitude, longitude, 0.0, heading, (0.0, 0.0, 0.0, 0.0))
        elif self._datum is None and None not in (self._fix, self._odometry, self._yaw):
            fix, pose = self._fix, self._odometry.pose.pose
            at = pose.position
            heading = self._yaw + float(self._values["yaw_offset"])
            heading += float(self._values["magnetic_declination_radians"])
            robot = (at.x, at.y, at.z, yaw_of(pose.orientation))
            lever = self._lever(fix)
            cosine, sine = math.cos(robot[3]), math.sin(robot[3])
            x, y = robot[0] + cosine * lever[0] - sine * lever[1], robot[1] + sine * lever[0] + cosine * lever[1]
            self._set_origin(fix.latitude, fix.longitude, fix.altitude, heading, (x, y, robot[2] + lever[2], robot[3]))

    def _set_origin(self, latitude, longitude, altitude, heading, world):
        """Set the transform from a point of the grid with a heading to the same point of the world frame."""
        self._zone = UtmZone.around(latitude, longitude)
        heading += self._zone.convergence(latitude, longitude)
        angle = world[3] - heading
        self._rotation = (math.cos(angle), math.sin(angle))
        x, y = self._turned(*self._zone.project(latitude, longitude))
        self._shift = (world[0] - x, world[1] - y, world[2] - altitude)
        self._is_known = True
        self.get_logger().info(
            f"Datum (latitude, longitude, altitude) is ({latitude:.8f}, {longitude:.8f}, {altitude:.2f})"
        )
        if self._values["broadcast_utm_transform"] or self._values["broadcast_cartesian_transform"]:
            self._broadcast(angle)

    def _turned(self, x, y):
        cosine, sine = self._rotation
        return cosine * x - sine * y, sine * x + cosine * y

    def _in_world(self, latitude, longitude, altitude):
        x, y = self._turned(*self._zone.project(latitude, longitude))
        z = 0.0 if self._values["zero_altitude"] else altitude + self._shift[2]
        return x + self._shift[0], y + self._shift[1], z

    def _in_degrees(self, x, y):
        cosine, sine = self._rotation
        x, y = x - self._shift[0], y - self._shift[1]
        return self._zone.unproject(cosine * x + sine * y, cosine * y - sine * x)

    def _broadcast(self, angle):
        message = TransformStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        names = self._values
        is_parent = names["broadcast_utm_transform_as_parent_frame"]
        if is_parent or names["broadcast_cartesian_transform_as_parent_frame"]:
            cosine, sine = self._rotation
            x, y, z = (-value for value in self._shift)
            x, y, angle = cosine * x + sine * y, cosine * y - sine * x, -angle
            message.header.frame_id, message.child_frame_id = "utm", self._world_frame
        else:
            x, y, z = self._shift
            message.header.frame_id, message.child_frame_id = self._world_frame, "utm"
        at, turn = message.transform.translation, message.transform.rotation
        at.x, at.y, at.z = x, y, 0.0 if names["zero_altitude"] else z
        turn.z, turn.w = math.sin(angle / 2), math.cos(angle / 2)
        self._broadcaster.sendTransform(message)

    def _lever(self, fix):
        """Return the position of the receiver in the frame of the robot [m]; zeros if its frame is not known."""
        try:
            stamped = self._buffer.lookup_transform(self._base_frame, fix.header.frame_id, Time())
        except TransformException:
            return 0.0, 0.0, 0.0
        at = stamped.transform.translation
        return at.x, at.y, at.z

    # ------------------------------------------------------------------ output

    def _publish(self, fix):
        message = Odometry()
        message.header.stamp, message.header.frame_id = fix.header.stamp, self._world_frame
        x, y, z = self._in_world(fix.latitude, fix.longitude, fix.altitude)
        yaw = yaw_of(self._odometry.pose.pose.orientation) if self._odometry is not None else 0.0
        lever = self._lever(fix)
        x -= math.cos(yaw) * lever[0] - math.sin(yaw) * lever[1]
        y -= math.sin(yaw) * lever[0] + math.cos(yaw) * lever[1]
        at = message.pose.pose.position
        at.x, at.y, at.z = x, y, 0.0 if self._values["zero_altitude"] else z - lever[2]
        message.pose.pose.orientation.w = 1.0
        cosine, sine = self._rotation
        given = [float(value) for value in fix.position_covariance]
        rows = ((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0))
        for i in range(3):
            for j in range(3):
                terms = (rows[i][a] * given[3 * a + b] * rows[j][b] for a in range(3) for b in range(3))
                message.pose.covariance[6 * i + j] = math.fsum(terms)
        self._gps.publish(message)

    def _publish_filtered(self, odometry):
        at, message = odometry.pose.pose.position, NavSatFix()
        message.header.stamp, message.header.frame_id = odometry.header.stamp, self._base_frame
        message.latitude, message.longitude = self._in_degrees(at.x, at.y)
        message.altitude = at.z - self._shift[2]
        self._filtered.publish(message)

    # ------------------------------------------------------------------ services

    def _on_datum(self, request, response):
        at = request.geo_pose.position
        heading = yaw_of(request.geo_pose.orientation)
        self._set_origin(at.latitude, at.longitude, at.altitude, heading, (0.0, 0.0, 0.0, 0.0))
        return response

    def _on_to_ll(self, request, response):
        if self._is_known:
            at = request.map_point
            response.ll_point.latitude, response.ll_point.longitude = self._in_degrees(at.x, at.y)
            response.ll_point.altitude = at.z - self._shift[2]
        return response

    def _on_from_ll(self, request, response):
        if self._is_known:
            at, point = request.ll_point, response.map_point
            point.x, point.y, point.z = self._in_world(at.latitude, at.longitude, at.altitude)
        return response


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    run(NavSatTransform())


if __name__ == "__main__":
    main()
