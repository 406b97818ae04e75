"""Displays of paths, poses, odometry and polygons, with RViz's colours."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Pose
from simkit.extend import counted
from simkit.linear_algebra import det, dot, norm
from simkit.matrix_decompositions import eigh
from simkit.msgs import Message
from simkit.pose import IDENTITY
from simkit_view.displays.display import (
    Display,
    DisplayTools,
    NewestMessage,
    draw_arrow,
    frame_of,
    pose_of,
    pose_rows,
    unknown_frame,
)
from simkit_view.displays.drawing import Colour, Drawing, Floats
from simkit_view.displays.frame_poses import Placement

_GREEN: Final[Colour] = (0.1, 1.0, 0.0, 1.0)
_RED: Final[Colour] = (1.0, 0.1, 0.0, 1.0)
_SPREAD: Final[Colour] = (0.8, 0.2, 0.8, 0.35)  # of positions
_TURN_SPREAD: Final[Colour] = (1.0, 1.0, 0.5, 0.45)  # of headings
_ARROW: Final = (0.35, 0.03, 0.12, 0.08)  # [m] sizes of the arrow of a pose
_FLAT_ARROW: Final = 0.18  # [m] length of the arrows of many poses
_WIDTH: Final = 0.02  # [m] of lines
_LIFT: Final = 0.01  # [m] of flat lines above the ground
_MOST_POSES: Final = 10_000
_MOST_PATH: Final = 50_000
_FAN: Final = 12  # triangles of the spread of a heading
_TRAIL: Final = 100  # arrows of odometry, as in RViz
_TRAIL_DISTANCE, _TRAIL_ANGLE = 0.1, 0.1  # [m], [rad] between two of them


class PathDisplay(NewestMessage):
    """Path as a line."""

    types = ("nav_msgs/msg/Path",)

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        places, _ = pose_rows([stamped.pose for stamped in _thinned(message.poses, drawing)], _MOST_PATH, drawing)
        drawing.strip(at, places + np.array((0.0, 0.0, _LIFT)), _GREEN, _WIDTH)


def _thinned(poses: Sequence[Message], drawing: Drawing) -> Sequence[Message]:
    step = 1 + (len(poses) - 1) // _MOST_PATH
    if step > 1:
        drawing.tell(f"of {counted(len(poses), 'pose')} every {step}th is drawn")
    return poses[::step]


class PoseArrayDisplay(NewestMessage):
    """Poses as flat arrows, such as the particles of a localisation."""

    types = ("geometry_msgs/msg/PoseArray", "nav2_msgs/msg/ParticleCloud")

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        poses = message.poses if hasattr(message, "poses") else [particle.pose for particle in message.particles]
        places, turns = pose_rows(poses, _MOST_POSES, drawing)
        shape = _FLAT_ARROW * np.array([(0, 0, 0), (1, 0, 0), (1, 0, 0), (0.7, 0.2, 0), (1, 0, 0), (0.7, -0.2, 0)])
        ends = np.einsum("nij,kj->nki", turns, shape) + places[:, None] + np.array((0.0, 0.0, _LIFT))
        drawing.lines(at, ends.reshape(-1, 3), _RED, _WIDTH / 2)


class PoseDisplay(NewestMessage):
    """Pose as an arrow; with a covariance, also the ellipse of one standard deviation and the spread of the heading."""

    types = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped")

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        has_spread = hasattr(message.pose, "covariance")
        pose = pose_of(message.pose.pose if has_spread else message.pose, drawing)
        if pose is None:
            return
        draw_arrow(drawing, at, pose, _ARROW, _RED)
        if has_spread:
            draw_covariance(drawing, at, pose, message.pose.covariance)


class OdometryDisplay(Display):
    """Last poses of odometry as arrows, and the covariance of the newest one."""

    types = ("nav_msgs/msg/Odometry",)

    def __init__(self, topic: str, tools: DisplayTools) -> None:
        super().__init__(topic, tools)
        self._trail: deque[tuple[Placement, Pose]] = deque(maxlen=_TRAIL)
        self._newest: Message | None = None
        self._at: Placement | None = None
        self._told = Drawing()
        self._time_ns = 0

    def take(self, message: Message, time_ns: int) -> None:
        if time_ns < self._time_ns:  # a reset
            self._trail.clear()
        self._time_ns = time_ns
        odometry = message
        self._newest, self._at, self._told = message, self.fixed(frame_of(message)), Drawing()
        pose = pose_of(odometry.pose.pose, self._told)
        self.has_changed = True
        if pose is None or self._at is None:
            return
        last = self._trail[-1][1] if self._trail else None
        if last is not None:
            angle = 2 * math.acos(min(1.0, abs(dot(pose.quaternion, last.quaternion))))
            if norm(pose.position - last.position) < _TRAIL_DISTANCE and angle < _TRAIL_ANGLE:
                return
        self._trail.append((self._at, pose))

    def draw(self, drawing: Drawing, time_ns: int) -> None:
        for problem in self._told.problems:
            drawing.tell(problem)
        for at, pose in self._trail:
            draw_arrow(drawing, at, pose, _ARROW, _RED)
        if self._newest is None:
            return
        if self._at is None:
            drawing.tell(unknown_frame(frame_of(self._newest)))
            return
        pose_now = pose_of(self._newest.pose.pose, drawing)
        if pose_now is not None:
            draw_arrow(drawing, self._at, pose_now, _ARROW, _RED)
            draw_covariance(drawing, self._at, pose_now, self._newest.pose.covariance)


class PolygonDisplay(NewestMessage):
    """Polygon as a closed line, such as the footprint of a robot."""

    types = ("geometry_msgs/msg/PolygonStamped", "geometry_msgs/msg/Polygon")

    def draw_message(self, drawing: Drawing, message: Message, at: Placement) -> None:
        corners = message.polygon.points if hasattr(message, "polygon") else message.points
        if len(corners):
            points = np.array([(c.x, c.y, c.z) for c in (*corners[:_MOST_PATH], corners[0])], np.float64)
            drawing.strip(at, points + np.array((0.0, 0.0, _LIFT)), _GREEN, _WIDTH)


def draw_covariance(drawing: Drawing, at: Placement, pose: Pose, covariance: npt.ArrayLike) -> None:
    """Draw a covariance of x, y, z, roll, pitch and yaw: the ellipsoid of one standard deviation, and a fan of yaw.

    The position's covariance is in the axes of the frame, and that of the rotation about its fixed axes.
    """
    values = np.asarray(covariance, np.float64).reshape(-1)
    if values.size != 36 or not np.isfinite(values).all():
        drawing.tell("a covariance with NaN or infinite values is not drawn")
        return
    matrix = values.reshape(6, 6)
    variances, axes = eigh((matrix[:3, :3] + matrix[:3, :3].T) / 2)
    if variances.min() < -1e-9:
        drawing.tell("a covariance with negative variances is not drawn")
        return
    sizes = np.maximum(2 * np.sqrt(np.maximum(variances, 0.0)), 0.004)
    if det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    if variances.max() > 0:
        row = [*pose.position, *_quaternion(axes), *sizes, *_SPREAD]
        drawing.shapes("sphere", at, np.array(row))
    deviation = min(math.sqrt(max(matrix[5, 5], 0.0)), math.pi)
    if deviation > 0:
        yaw = float(pose.rpy[2])
        angles = yaw + deviation * np.linspace(-1, 1, _FAN + 1)
        rim = pose.position + 0.5 * np.stack((np.cos(angles), np.sin(angles), np.full(_FAN + 1, _LIFT)), axis=1)
        centre = np.broadcast_to(pose.position + np.array((0.0, 0.0, _LIFT)), (_FAN, 3))
        drawing.triangles(at, np.stack((centre, rim[:-1], rim[1:]), axis=1).reshape(-1, 3), _TURN_SPREAD)


def _quaternion(matrix: Floats) -> list[float]:
    import mujoco

    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix).ravel())
    return quaternion.tolist() if np.isfinite(quaternion).all() else IDENTITY.quaternion.tolist()
