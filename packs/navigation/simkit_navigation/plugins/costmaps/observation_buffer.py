"""Scans and point clouds of a source of a costmap layer, as Nav2's `ObservationBuffer` stores them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from simkit import Pose, msgs
from simkit.errors import ArgumentValueError, TransformError
from simkit.extend import Options, boolean, choice, number, text
from simkit_navigation.plugins.navigation.planar_pose import Floats

if TYPE_CHECKING:
    from simkit_navigation.plugins.costmaps.costmap_node import CostmapNode

SCAN: Final = "sensor_msgs/msg/LaserScan"
CLOUD: Final = "sensor_msgs/msg/PointCloud2"
_INF_MARGIN: Final = 1e-4  # [m] below range_max, where Nav2 places an infinite range that is valid

Singles = npt.NDArray[np.float32]
Points = tuple[Singles, Singles, Singles]
"""x, y and z of points [m]."""


class SourceOptions(Options):
    """Options of a source of `ObstacleLayer` and `VoxelLayer`."""

    topic: str = text("scan")
    data_type: str = choice(("LaserScan", "PointCloud2"), "LaserScan")
    sensor_frame: str = text("")
    observation_persistence: float = number(0.0, "s", minimum=0)
    expected_update_rate: float = number(0.0, "s", minimum=0)
    marking: bool = boolean(True)
    clearing: bool = boolean(True)
    inf_is_valid: bool = boolean(False)
    min_obstacle_height: float = number(-math.inf, "m", finite=False)
    max_obstacle_height: float = number(math.inf, "m", finite=False)
    obstacle_max_range: float = number(2.5, "m", minimum=0)
    obstacle_min_range: float = number(0.0, "m", minimum=0)
    raytrace_max_range: float = number(3.0, "m", minimum=0)
    raytrace_min_range: float = number(0.0, "m", minimum=0)


@dataclass(frozen=True, eq=False)
class Observation:
    """Points that a sensor saw at one time.

    Attributes:
        origin: position of the sensor in the frame of the costmap [m].
        points: points in the frame of the costmap [m], with the heights that the source allows.
    """

    origin: tuple[float, float, float]
    points: Points


class ObservationBuffer:
    """Newest messages of a source.

    Without `<observation_persistence>`, this is the newest message, however old it is; else all that are not older.

    Args:
        node: plugin of the costmap.
        options: options of the source.
    """

    def __init__(self, node: CostmapNode, options: SourceOptions) -> None:
        self._node, self.options = node, options
        self.messages: list[msgs.Message] = []  # the newest one is the first
        self._observations: list[tuple[str, Observation] | None] = []
        self._updated_ns = node.sim.time_ns
        self._has_told = False

    def add(self, message: msgs.Message) -> None:
        """Store a message."""
        self._updated_ns, self._has_told = self._node.sim.time_ns, False
        if self.options.observation_persistence <= 0:
            self.messages, self._observations = [message], [None]
        else:
            self.messages.insert(0, message)
            self._observations.insert(0, None)
            self._purge()

    def clear(self) -> None:
        """Forget all messages."""
        self.messages, self._observations = [], []
        self._updated_ns = self._node.sim.time_ns

    def _purge(self) -> None:
        """Remove messages that are older than `<observation_persistence>`."""
        if self.options.observation_persistence <= 0:
            return
        oldest = self._node.sim.time_ns - round(self.options.observation_persistence * 1e9)
        for index, message in enumerate(self.messages):
            stamp = message.header.stamp
            if stamp.sec * 1_000_000_000 + stamp.nanosec < oldest:
                del self.messages[index:], self._observations[index:]
                return

    def current_messages(self) -> list[msgs.Message]:
        """Return the messages that are in effect, the newest one first; a late source is reported once."""
        expected = self.options.expected_update_rate
        late = (self._node.sim.time_ns - self._updated_ns) * 1e-9
        if expected > 0 and late > expected and not self._has_told:
            self._has_told = True
            text = "no message on %s for %.2f s; expected_update_rate is %.2f s"
            self._node.log.warning(text, self.options.topic, late, expected)
        self._purge()
        return list(self.messages)

    def observations(self, frame: str) -> list[Observation]:
        """Return the points of all messages in effect in a frame; messages without a transform are left out.

        Args:
            frame: frame of the costmap.
        """
        result = []
        for index, message in enumerate(self.current_messages()):
            stored = self._observations[index]
            if stored is not None and stored[0] == frame:
                result.append(stored[1])
                continue
            sensor = find_pose(self._node, frame, message)
            if sensor is None:
                continue
            pose, is_exact = sensor
            seen = _observe(self._node, frame, message, pose, self.options)
            if seen is not None:
                result.append(seen)
                if is_exact:
                    self._observations[index] = (frame, seen)
        return result


def find_pose(node: CostmapNode, frame: str, message: msgs.Message, source: str = "") -> tuple[Pose, bool] | None:
    """Return the pose of the sensor of a message, and whether it is that of the message's time; None without one.

    Args:
        node: plugin of the costmap.
        frame: frame in which the pose is given.
        message: message.
        source: frame of the sensor; empty for that of the message.
    """
    source = source or message.header.frame_id
    if source == frame:
        return Pose(), True
    for stamp in (message.header.stamp, None):  # the newest transform may be older than the message
        try:
            return node.sim.tf.lookup(frame, source, stamp), stamp is not None
        except (TransformError, ArgumentValueError):  # a message may name no frame
            continue
    return None


def _observe(
    node: CostmapNode, frame: str, message: msgs.Message, pose: Pose, options: SourceOptions
) -> Observation | None:
    is_scan = options.data_type == "LaserScan"
    points = points_of_scan(message, options.inf_is_valid) if is_scan else points_of_cloud(node, message, options.topic)
    if points is None:
        return None
    origin = pose
    if options.sensor_frame:
        placed = find_pose(node, frame, message, options.sensor_frame)
        if placed is None:
            text = f"there is no transform from {options.sensor_frame!r} (<sensor_frame>) to {frame!r}"
            node.report_once(f"frame {options.topic}", f"{text}; messages on {options.topic} are ignored")
            return None
        origin = placed[0]
    x, y, z = transformed(pose, points)
    low, high = np.float32(options.min_obstacle_height), np.float32(options.max_obstacle_height)
    is_kept = (z >= low) & (z <= high)
    if not is_kept.all():
        x, y, z = x[is_kept], y[is_kept], z[is_kept]
    at_x, at_y, at_z = origin.position.tolist()
    return Observation((at_x, at_y, at_z), (x, y, z))


def points_of_scan(scan: msgs.LaserScan, inf_is_valid: bool) -> Points | None:
    """Return the points of a laser scan in the frame of the sensor, as `laser_geometry` projects them.

    Args:
        scan: scan.
        inf_is_valid: True if infinite ranges are points just below the largest range.
    """
    if not math.isfinite(scan.angle_min + scan.angle_increment):
        return None
    ranges: Floats = np.asarray(scan.ranges, np.float64)
    if inf_is_valid:
        ranges = np.where(ranges == math.inf, scan.range_max - _INF_MARGIN, ranges)
    angles: Floats = np.asarray(scan.angle_min + scan.angle_increment * np.arange(len(ranges)), np.float64)
    is_valid = (ranges >= scan.range_min) & (ranges < scan.range_max) & np.isfinite(ranges)
    reach, at = ranges[is_valid], angles[is_valid]
    x, y = (reach * np.cos(at)).astype(np.float32), (reach * np.sin(at)).astype(np.float32)
    return x, y, np.zeros(len(x), np.float32)


def points_of_cloud(node: CostmapNode, cloud: msgs.PointCloud2, topic: str) -> Points | None:
    """Return the finite points of a point cloud in its frame; None, with an error once, if it has no x, y and z."""
    try:
        points = msgs.points(cloud)
        x, y, z = (np.asarray(points[axis], np.float32) for axis in ("x", "y", "z"))
    except (ArgumentValueError, ValueError) as error:
        node.report_once(f"cloud {topic}", f"a point cloud on {topic} is ignored: {error}")
        return None
    is_finite = np.isfinite(x) & np.isfinite(y) & np.isfinite(z)
    return (x, y, z) if is_finite.all() else (x[is_finite], y[is_finite], z[is_finite])


def transformed(pose: Pose, points: Points) -> Points:
    """Return points of the frame of a pose in the frame in which the pose is given; products and sums of float32."""
    rotation = pose.matrix[:3, :3].astype(np.float32).tolist()
    place = pose.position.astype(np.float32).tolist()
    x, y, z = points
    one, two, three = (
        np.float32(row[0]) * x + np.float32(row[1]) * y + np.float32(row[2]) * z + np.float32(at)
        for row, at in zip(rotation, place, strict=True)
    )
    return one, two, three
