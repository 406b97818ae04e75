"""Outline of a robot, as Nav2's costmaps describe it: a radius or a polygon."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs
from simkit.extend import SharedByCopies
from simkit_navigation.plugins.costmaps.cost_grid import INSCRIBED, LETHAL, UNKNOWN, CostGrid, Indices
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


def cells_within(grid: CostGrid, outline: Footprint, robot: PlanarPose) -> tuple[Indices, Indices]:
    """Return rows and columns of the cells that a robot covers: a disc, or the polygon with the cells of its edges."""
    if outline.is_round:
        radius = min(outline.inscribed_radius, grid.diagonal)
        reach = np.arange(-radius, radius + grid.resolution, grid.resolution / 2)
        around = np.stack(np.meshgrid(reach, reach), axis=-1).reshape(-1, 2)
        rows, columns, inside = grid.indices(around[np.hypot(*around.T) <= radius] + (robot.x, robot.y))
        return rows[inside], columns[inside]
    corners = robot.transform(outline.corners)
    rows, columns, inside = grid.indices(edge_points(corners, grid.resolution / 2))
    mask = np.zeros(grid.cells.shape, np.bool_)
    mask[rows[inside], columns[inside]] = True
    low = [max(int(axis.min()), 0) for axis in (rows, columns)]
    high = [min(int(axis.max()) + 1, count) for axis, count in zip((rows, columns), grid.cells.shape, strict=True)]
    if low[0] < high[0] and low[1] < high[1]:
        row_at, column_at = (axis.ravel() for axis in np.mgrid[low[0] : high[0], low[1] : high[1]])
        x, y = grid.centres(row_at, column_at).T
        is_inside = np.zeros(len(x), np.bool_)
        for (x1, y1), (x2, y2) in zip(corners, np.roll(corners, 1, axis=0), strict=True):
            if y1 != y2:  # an edge is crossed by the ray to the right
                is_inside ^= ((y1 > y) != (y2 > y)) & (x < (x2 - x1) * (y - y1) / (y2 - y1) + x1)
        mask[row_at[is_inside], column_at[is_inside]] = True
    found_rows, found_columns = np.nonzero(mask)
    return found_rows, found_columns


def edge_points(corners: Floats, spacing: float) -> Floats:
    """Return points on the edges of a polygon, at most a distance apart [m], shape (n, 2) [m].

    Args:
        corners: corners of the polygon in their order, shape (m, 2) [m].
        spacing: largest distance between two neighbouring points [m].
    """
    points = []
    for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        count = max(1, math.ceil(math.hypot(*(end - begin).tolist()) / spacing))
        parts = (np.arange(count) / count)[:, None]
        points.append(begin + parts * (end - begin))
    return np.concatenate(points)


def padded(outline: Footprint, padding: float) -> Footprint:
    """Return an outline whose corners are moved outward along x and y by a distance [m], as Nav2's `padFootprint`."""
    if padding <= 0:
        return outline
    corners = outline.corners + np.sign(np.where(np.abs(outline.corners) < 1e-9, 0.0, outline.corners)) * padding
    return _polygon(corners, outline.is_round)


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
    return _polygon(corners, False)


def _polygon(corners: Floats, is_round: bool) -> Footprint:
    edges = np.roll(corners, -1, axis=0) - corners
    squares = np.maximum((edges**2).sum(axis=1), 1e-12)
    parts = np.clip(-(corners * edges).sum(axis=1) / squares, 0.0, 1.0)
    nearest = np.hypot(*(corners + parts[:, None] * edges).T)
    return Footprint(corners, is_round, float(nearest.min()), float(np.hypot(*corners.T).max()))
