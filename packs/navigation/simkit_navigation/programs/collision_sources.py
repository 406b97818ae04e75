"""Sources and zones of Nav2's collision monitor and collision detector."""

import ast
import math

import numpy as np
from geometry_msgs.msg import Point, Point32, PolygonInstanceStamped, PolygonStamped
from node_support import ServerNode, warn, warn_of_type
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import LaserScan, PointCloud2, Range
from sensor_msgs_py.point_cloud2 import read_points
from tf2_ros import Buffer, TransformException, TransformListener
from visualization_msgs.msg import Marker, MarkerArray

from simkit.pose import quat_to_matrix
from simkit_navigation.plugins.navigation.collision_zones import ACTIONS, CollisionZone, VelocityRange

NO_POINTS = np.zeros((0, 2))
TYPES = {"scan": LaserScan, "pointcloud": PointCloud2, "range": Range, "polygon": PolygonInstanceStamped}
"""Types of the messages by the type of a source."""
ZONE_TYPES = ("polygon", "circle", "velocity_polygon")


class ZoneNode(ServerNode):
    """Node with zones around the robot, and with sources of points of obstacles."""

    def __init__(self, name):
        super().__init__(name, automatically_declare_parameters_from_overrides=True)
        self.zones, self._opened, self._drawings = {}, [], {}
        self._invalid = set()  # parameters with a value of another type

    def value(self, name, default):
        """Return a parameter, or a default, which replaces a value of another type."""
        value = self.get_parameter(name).value if self.has_parameter(name) else default
        is_number = isinstance(value, int | float) and not isinstance(value, bool) and not math.isnan(value)
        wants_number = isinstance(default, int | float) and not isinstance(default, bool)
        if is_number if wants_number else isinstance(value, type(default)):
            return value
        if name not in self._invalid:
            self._invalid.add(name)
            warn_of_type(self, name, value, default)
        return default

    def configure_zones(self):
        """Read the sources and the zones, and open their topics."""
        self._base = self.value("base_frame_id", "base_footprint")
        self._fixed = self.value("odom_frame_id", "odom") if self.value("base_shift_correction", True) else ""
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._received = {}
        self._drawings["~"] = self.create_publisher(MarkerArray, "~/collision_points_marker", 1)
        names = self._names("observation_sources")
        unknown = [name for name in names if not self._add_source(name)]
        if unknown:
            text = f"the sources {', '.join(unknown)} are left out: their type is not one of {', '.join(TYPES)}"
            warn(self, "SK-NAV-004", text)
        left_out = [name for name in self._names("polygons") if not self._add_zone(name)]
        if left_out:
            warn(self, "SK-NAV-004", f"the polygons {', '.join(left_out)} are not checked: their type is not available")

    def close_zones(self):
        """Close the topics of sources and zones."""
        for subscription in self._opened:
            self.destroy_subscription(subscription)
        for publisher in self._drawings.values():
            self.destroy_publisher(publisher)
        self.zones, self._opened, self._drawings = {}, [], {}

    def _names(self, name):
        return [each for each in self.value(name, []) or [] if each]

    # ------------------------------------------------------------------ zones

    def _add_zone(self, name):
        """Read a zone; return False for a kind of zone that is not available."""

        def value(parameter, default):
            return self.value(f"{name}.{parameter}", default)

        kind, action = value("type", "polygon"), value("action_type", "none")
        if not value("enabled", True):
            return True
        if kind not in ZONE_TYPES or action not in ACTIONS:
            return False
        ranges = self._velocity_ranges(name) if kind == "velocity_polygon" else ()
        corners = None if kind == "circle" else NO_POINTS if ranges else corners_of(value("points", ""))
        if not ranges and corners is not None and not len(corners):
            topic = value("polygon_sub_topic", "")
            if action == "approach":
                topic = topic or value("footprint_topic", "local_costmap/published_footprint")
            topic = topic or value("footprint_topic", "")
            if not topic:
                return False
            durability = value("polygon_subscribe_transient_local", False)
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL) if durability else 1
            self._opened.append(
                self.create_subscription(PolygonStamped, topic, lambda message: self._on_footprint(name, message), qos)
            )
        least = value("max_points", 3) + 1 if self.has_parameter(f"{name}.max_points") else value("min_points", 4)
        self.zones[name] = CollisionZone(
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
            tuple(self._names(f"{name}.sources_names")) or None,
            ranges,
        )
        if value("visualize", False):
            topic = value("polygon_pub_topic", name)
            self._drawings[name] = self.create_publisher(PolygonStamped, topic, 10)
        return True

    def _velocity_ranges(self, name):
        """Read the polygons of a `velocity_polygon`."""
        is_holonomic = self.value(f"{name}.holonomic", False)
        ranges = []
        for part in self._names(f"{name}.velocity_polygons"):

            def value(parameter, default, prefix=f"{name}.{part}"):
                return self.value(f"{prefix}.{parameter}", default)

            limits = [
                (float(value(low, -math.inf)), float(value(high, math.inf)))
                for low, high in (("linear_min", "linear_max"), ("theta_min", "theta_max"))
            ]
            direction = None
            if is_holonomic:
                direction = value("direction_start_angle", -math.pi), value("direction_end_angle", math.pi)
            ranges.append(VelocityRange(corners_of(value("points", "")), *limits, direction))
        return tuple(ranges)

    def _on_footprint(self, name, message):
        corners = np.array([(point.x, point.y, 0.0) for point in message.polygon.points])
        if len(corners) < 3:
            return
        pose = self._pose_of(message.header.frame_id, Time(), "")
        if pose is not None and name in self.zones:
            self.zones[name] = CollisionZone(**{**vars(self.zones[name]), "corners": moved(pose, corners)[:, :2]})

    def publish_zones(self, velocity):
        """Publish the polygons that have a topic, as they are for a velocity."""
        for name, zone in self.zones.items():
            publisher = self._drawings.get(name)
            if publisher is None:
                continue
            zone = zone.at_velocity(velocity)
            corners = zone.corners
            if corners is None:  # Nav2 draws a circle with 16 corners
                angles = np.arange(16) * math.tau / 16
                corners = zone.radius * np.column_stack((np.cos(angles), np.sin(angles)))
            message = PolygonStamped()
            message.header.frame_id = self._base
            message.header.stamp = self.get_clock().now().to_msg()
            message.polygon.points = [Point32(x=float(x), y=float(y)) for x, y in corners]
            publisher.publish(message)

    def publish_points(self, points):
        """Publish the points of each source as a marker, if there is a subscriber.

        Args:
            points: points by the name of their source.
        """
        publisher = self._drawings["~"]
        if not publisher.get_subscription_count():
            return
        markers = []
        for name, found in points.items():
            marker = Marker(ns=f"collision_points_{name}", type=Marker.POINTS, action=Marker.ADD, frame_locked=True)
            marker.header.frame_id = self._base
            marker.scale.x = marker.scale.y = 0.02
            marker.color.r = marker.color.a = 1.0
            marker.points = [Point(x=float(x), y=float(y)) for x, y in found]
            markers.append(marker)
        publisher.publish(MarkerArray(markers=markers))

    # ------------------------------------------------------------------ sources

    def _add_source(self, name):
        """Subscribe to a source; return False if its type is not known."""
        kind = TYPES.get(self.value(f"{name}.type", "scan"))
        if kind is None:
            return False
        if not self.value(f"{name}.enabled", True):
            return True
        topic = self.value(f"{name}.topic", "scan")
        self._received[name] = {} if kind is PolygonInstanceStamped else None

        def on_message(message):
            if kind is PolygonInstanceStamped:
                self._received[name][message.polygon.id] = message
            else:
                self._received[name] = message

        self._opened.append(self.create_subscription(kind, topic, on_message, qos_profile_sensor_data))
        return True

    def points_by_source(self):
        """Return the points of each source in the frame of the robot; None for a source without valid data."""
        return {name: self._points_of(name) for name in self._received}

    def is_required(self, name):
        """Check whether the robot stops without valid data of a source."""
        return self._timeout(name) > 0

    def _timeout(self, name):
        return float(self.value(f"{name}.source_timeout", self.value("source_timeout", 2.0)))

    def _is_old(self, name, message):
        age = self.get_clock().now().nanoseconds - Time.from_msg(message.header.stamp).nanoseconds
        return self.is_required(name) and age > self._timeout(name) * 1e9

    def _points_of(self, name):
        stored = self._received[name]
        if not stored:
            return None
        if isinstance(stored, dict):
            return self._points_of_polygons(name, stored)
        if self._is_old(name, stored):
            return None
        points = self._read(name, stored)
        pose = self._pose_of(stored.header.frame_id, stored.header.stamp, self._fixed)
        if points is None or pose is None:
            return None
        points = moved(pose, points)
        if isinstance(stored, PointCloud2) and not self.value(f"{name}.use_global_height", False):
            points = points[self._has_height(name, points[:, 2])]
        return points[:, :2]

    def _has_height(self, name, heights):
        low, high = self.value(f"{name}.min_height", 0.05), self.value(f"{name}.max_height", 0.5)
        return (heights >= low) & (heights <= high)

    def _read(self, name, message):
        """Return the points of a message in its frame, shape (n, 3); None if it is not valid."""
        if isinstance(message, LaserScan):
            ranges = np.asarray(message.ranges, np.float64)
            angles = message.angle_min + message.angle_increment * np.arange(len(ranges))
            is_hit = (ranges >= message.range_min) & (ranges <= message.range_max)
            return on_arc(ranges[is_hit], angles[is_hit])
        if isinstance(message, Range):
            if not message.min_range <= message.range <= message.max_range:
                return None
            half, step = message.field_of_view / 2, float(self.value(f"{name}.obstacles_angle", math.pi / 180))
            angles = np.append(np.arange(-half, half, max(step, 1e-4)), half)
            return on_arc(np.full(len(angles), message.range), angles)
        has_height = self.value(f"{name}.use_global_height", False)
        fields = ["x", "y", "z"] + (["height"] if has_height else [])
        if not {field.name for field in message.fields} >= set(fields):
            self.get_logger().warning(f"[{name}]: the point cloud has no fields {', '.join(fields)}", once=True)
            return None
        table = read_points(message, field_names=fields)
        columns = np.column_stack([np.asarray(table[field], np.float64).reshape(-1) for field in fields])
        columns = columns[np.isfinite(columns).all(axis=1)]
        if has_height:
            columns = columns[self._has_height(name, columns[:, 3])]
        points = columns[:, :3]
        least = float(self.value(f"{name}.min_range", 0.0))
        return points[points[:, 0] ** 2 + points[:, 1] ** 2 + points[:, 2] ** 2 >= least**2]

    def _points_of_polygons(self, name, polygons):
        """Return points on the edges of polygons, at a distance of `sampling_distance` at most."""
        for number in [number for number, polygon in polygons.items() if self._is_old(name, polygon)]:
            del polygons[number]
        spacing, parts = max(float(self.value(f"{name}.sampling_distance", 0.1)), 1e-3), [NO_POINTS]
        for message in polygons.values():
            pose = self._pose_of(message.header.frame_id, message.header.stamp, self._fixed)
            if pose is None:
                return None
            corners = moved(pose, np.array([(p.x, p.y, 0.0) for p in message.polygon.polygon.points]).reshape(-1, 3))
            for start, end in zip(corners[:, :2], np.roll(corners[:, :2], -1, axis=0), strict=True):
                count = max(math.ceil(math.dist(start, end) / spacing), 1)
                parts.append(start + np.arange(count + 1)[:, None] / count * (end - start))
        return np.concatenate(parts)

    def _pose_of(self, frame, stamp, fixed):
        """Return rotation (3, 3) and position of a frame in that of the robot; None if it is not known.

        With a fixed frame, the robot may have moved since the time of the data.
        """
        if frame == self._base and not fixed:
            return np.eye(3), np.zeros(3)
        arguments = [(self._base, frame, Time())]
        if fixed:
            arguments.insert(0, (self._base, Time(), frame, stamp, fixed))
        for words in arguments:
            try:
                look_up = self._buffer.lookup_transform_full if len(words) == 5 else self._buffer.lookup_transform
                transform = look_up(*words).transform
            except TransformException:
                continue
            at, q = transform.translation, transform.rotation
            return quat_to_matrix((q.w, q.x, q.y, q.z)), np.array([at.x, at.y, at.z])
        if frame == self._base:
            return np.eye(3), np.zeros(3)
        return None


def moved(pose, points):
    """Return points of a frame in the frame in which its pose is given, shape (n, 3)."""
    rotation, position = pose
    x, y, z = points.T
    return np.column_stack(
        [row[0] * x + row[1] * y + row[2] * z + at for row, at in zip(rotation, position, strict=True)]
    )


def on_arc(ranges, angles):
    """Return points at ranges and angles in the plane of a sensor, shape (n, 3)."""
    return np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))))


def corners_of(points):
    """Return the corners in a text `[[x, y], …]`, or in a list of numbers as in Humble."""
    try:
        numbers = ast.literal_eval(points) if isinstance(points, str) and points else points or []
        return np.array(numbers, np.float64).reshape(-1, 2)
    except (ValueError, SyntaxError):
        return NO_POINTS
