"""Outline of a robot, as Nav2's costmaps describe it: a radius or a polygon."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.extend import SharedByCopies
from simkit_navigation.plugins.navigation.cost_grid import INSCRIBED, LETHAL, UNKNOWN, CostGrid
from simkit_navigation.plugins.navigation.planar_pose import Floats, PlanarPose

if TYPE_CHECKING:
    from simkit import Plugin

_ROUND: Final = 16  # corners of a circle
_LEVER: Final = 0.5  # [m] from the robot's origin to a point that turns with it


@dataclass(frozen=True, eq=False)
class Footprint(SharedByCopies):
    """Outline of a robot in its own frame.

    Attributes:
        corners: x and y [m], shape (n, 2).
        is_round: True if a radius was given, not a polygon.
        inscribed_radius: largest radius around the origin within the outline [m].
        circumscribed_radius: smallest radius around the origin that contains the outline [m].
    """

    corners: Floats
    is_round: bool
    inscribed_radius: float
    circumscribed_radius: float

    def message(self, robot: PlanarPose, frame: str, time_ns: int) -> msgs.Message:
        """Return a `geometry_msgs/msg/PolygonStamped` of the outline at a pose."""
        points = [{"x": x, "y": y} for x, y in robot.transform(self.corners).tolist()]
        return msgs.make(
            "geometry_msgs/msg/PolygonStamped", header=msgs.header(time_ns, frame), polygon={"points": points}
        )

    def collides(self, grid: CostGrid, pose: PlanarPose) -> bool:
        """Check whether the outline at a pose touches an obstacle; unknown cells are free.

        The centre of a round robot must be in a cell below the cost INSCRIBED. The edges of a polygon must not cross an
        obstacle.
        """
        if self.is_round:
            return INSCRIBED <= grid.cost(pose.x, pose.y) < UNKNOWN
        ends = np.roll(self.corners, -1, axis=0)
        count = max(2, math.ceil(float(np.hypot(*(ends - self.corners).T).max()) / grid.resolution) + 1)
        parts = np.linspace(0.0, 1.0, count)[:, None, None]
        points = (self.corners + parts * (ends - self.corners)).reshape(-1, 2)
        return bool((grid.costs(pose.transform(points)) == LETHAL).any())

    def collides_ahead(self, grid: CostGrid, pose: PlanarPose, speeds: tuple[float, float], time: float) -> bool:
        """Check whether the outline touches an obstacle on the arc that the robot drives with constant speeds.

        Args:
            grid: costs.
            pose: pose at the beginning of the arc, which is not checked.
            speeds: forward speed [m/s] and turning rate [rad/s].
            time: duration of the motion [s]; a repeated circle, and the way outside of the grid, are left out.
        """
        forward, turning = speeds
        longest = math.pi * (grid.diagonal + 2 * self.circumscribed_radius)  # [m], an arc around the grid
        time = min(time, longest / abs(forward)) if forward else time
        time = min(time, math.tau / abs(turning)) if turning else time
        rate = max(abs(forward), abs(turning) * _LEVER)
        count = max(1, math.ceil(rate * time / (grid.resolution / 2))) if rate else 0
        now, period = pose, time / max(count, 1)
        for _ in range(count):
            yaw = now.yaw + turning * period / 2
            way = forward * period
            now = PlanarPose(now.x + way * math.cos(yaw), now.y + way * math.sin(yaw), now.yaw + turning * period)
            if self.collides(grid, now):
                return True
        return False


def round_footprint(radius: float) -> Footprint:
    """Return the outline of a round robot with a radius [m]."""
    angles = np.arange(_ROUND) * math.tau / _ROUND
    return Footprint(radius * np.column_stack((np.cos(angles), np.sin(angles))), True, radius, radius)


def read_footprint(node: Plugin, text: str, radius: float) -> Footprint:
    """Return the outline of Nav2's parameters `footprint` and `robot_radius`; an invalid polygon is an error.

    Args:
        node: plugin with the parameters.
        text: polygon, as `[[x, y], …]` [m]; empty or `[]` for a round robot.
        radius: radius of a round robot [m].
    """
    if text.replace(" ", "") in ("", "[]"):
        return round_footprint(radius)
    try:
        corners = np.array(ast.literal_eval(text), np.float64)
    except (ValueError, SyntaxError, TypeError, OverflowError, MemoryError, RecursionError):
        corners = np.zeros((0, 2))
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3 or not np.isfinite(corners).all():
        node.params.error(
            "SK-PARAM-002", f"footprint: found {text!r:.80}; expected [[x, y], …] with 3 corners or more [m]"
        )
        return round_footprint(radius)
    edges = np.roll(corners, -1, axis=0) - corners
    squares = np.maximum((edges**2).sum(axis=1), 1e-12)
    parts = np.clip(-(corners * edges).sum(axis=1) / squares, 0.0, 1.0)
    nearest = np.hypot(*(corners + parts[:, None] * edges).T)
    return Footprint(corners, False, float(nearest.min()), float(np.hypot(*corners.T).max()))
