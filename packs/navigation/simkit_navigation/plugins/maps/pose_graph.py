"""Graph of poses in the plane, and the poses that fit its measurements best.

The sparse normal equations of each Gauss-Newton step are solved by a Cholesky factorisation in plain Python, whose
order of operations is fixed. SciPy's sparse solvers call BLAS, whose last bits depend on the processor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from simkit.float_sum import float_sum
from simkit.pose import wrap_angle
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

_MOST_ITERATIONS: Final = 30
_ENOUGH: Final = 1e-7  # [m], [rad] by which the last step may move a pose
_FIRST_DAMPING: Final = 1e-6
_MOST_DAMPING: Final = 1e6

Row = dict[int, float]
Information = tuple[float, float, float, float]
"""Inverse of a covariance: xx, xy, yy [1/m²] and yaw [1/rad²]."""


@dataclass(frozen=True)
class Edge:
    """Measured pose of a node in the frame of another one.

    Attributes:
        first, second: indices of the nodes.
        pose: pose of the second node in the frame of the first.
        information: weight of the measurement, in the frame of the first.
        is_loop: whether the measurement closed a loop.
    """

    first: int
    second: int
    pose: PlanarPose
    information: Information
    is_loop: bool = False


def information_of(covariance: tuple[float, float, float, float], yaw: float) -> Information:
    """Return the information of a covariance (xx, xy, yy, yaw) of the map, in a frame that has a yaw in the map."""
    xx, xy, yy, turn = covariance
    cos, sin = math.cos(yaw), math.sin(yaw)
    a = cos * cos * xx + 2 * cos * sin * xy + sin * sin * yy
    b = cos * sin * (yy - xx) + (cos * cos - sin * sin) * xy
    c = sin * sin * xx - 2 * cos * sin * xy + cos * cos * yy
    determinant = max(a * c - b * b, 1e-12)
    return c / determinant, -b / determinant, a / determinant, 1.0 / max(turn, 1e-9)


def residual(edge: Edge, first: PlanarPose, second: PlanarPose) -> tuple[float, float, float]:
    """Return by how much the pose of the second node differs from the measured one, in the frame of the first."""
    cos, sin = math.cos(first.yaw), math.sin(first.yaw)
    dx, dy = second.x - first.x, second.y - first.y
    turn = wrap_angle(second.yaw - first.yaw - edge.pose.yaw)
    return cos * dx + sin * dy - edge.pose.x, cos * dy - sin * dx - edge.pose.y, turn


def optimised(poses: list[PlanarPose], edges: list[Edge]) -> list[PlanarPose]:
    """Return the poses with the smallest sum of weighted squared residuals; the first pose stays as it is.

    Levenberg-Marquardt: the damping grows until a step makes the sum smaller.
    """
    poses, order = list(poses), _elimination_order(len(poses), edges)
    cost, damping = _cost(poses, edges), _FIRST_DAMPING
    for _ in range(_MOST_ITERATIONS):
        rows, right = _equations(poses, edges)
        step = _solve(rows, right, order, damping)
        moved = [poses[0]]
        for k, pose in enumerate(poses[1:]):
            x, y, yaw = step[3 * k : 3 * k + 3]
            moved.append(PlanarPose(pose.x + x, pose.y + y, wrap_angle(pose.yaw + yaw)))
        found = _cost(moved, edges)
        if found <= cost:
            poses, cost, damping = moved, found, max(damping / 10.0, 1e-9)
            if max(map(abs, step), default=0.0) < _ENOUGH:
                break
        else:
            damping *= 10.0
            if damping > _MOST_DAMPING:
                break
    return poses


def _cost(poses: list[PlanarPose], edges: list[Edge]) -> float:
    """Return the sum of weighted squared residuals."""
    return float_sum(_weighted_square(edge, poses) for edge in edges)


def _weighted_square(edge: Edge, poses: list[PlanarPose]) -> float:
    x, y, turn = residual(edge, poses[edge.first], poses[edge.second])
    xx, xy, yy, yaw = edge.information
    return xx * x * x + 2 * xy * x * y + yy * y * y + yaw * turn * turn


def _equations(poses: list[PlanarPose], edges: list[Edge]) -> tuple[list[Row], list[float]]:
    """Return rows and right side of the normal equations; unknown 3 k belongs to the node k + 1."""
    size = 3 * (len(poses) - 1)
    rows: list[Row] = [{} for _ in range(size)]
    right = [0.0] * size
    for edge in edges:
        first, second = poses[edge.first], poses[edge.second]
        cos, sin = math.cos(first.yaw), math.sin(first.yaw)
        x, y, turn = residual(edge, first, second)
        xx, xy, yy, yaw = edge.information
        along, across = x + edge.pose.x, y + edge.pose.y  # second in the frame of the first
        # derivatives of the three residuals: columns x, y, yaw of the first and the second node
        columns = (
            (-cos, sin, 0.0),
            (-sin, -cos, 0.0),
            (across, -along, -1.0),
            (cos, -sin, 0.0),
            (sin, cos, 0.0),
            (0.0, 0.0, 1.0),
        )
        weighted = [(xx * a + xy * b, xy * a + yy * b, yaw * c) for a, b, c in columns]
        unknowns = [3 * (edge.first - 1) + k for k in range(3)] + [3 * (edge.second - 1) + k for k in range(3)]
        for i, (u, v, w) in zip(unknowns, weighted, strict=True):
            if i < 0:
                continue
            right[i] -= u * x + v * y + w * turn
            row = rows[i]
            for j, (a, b, c) in zip(unknowns, columns, strict=True):
                if j >= 0:
                    row[j] = row.get(j, 0.0) + (u * a + v * b + w * c)
    return rows, right


def _elimination_order(nodes: int, edges: list[Edge]) -> list[int]:
    """Return the unknowns in an order of elimination that keeps the factor sparse: nodes with few neighbours first."""
    neighbours: list[set[int]] = [set() for _ in range(nodes)]
    for edge in edges:
        if edge.first and edge.second:
            neighbours[edge.first].add(edge.second)
            neighbours[edge.second].add(edge.first)
    waiting: dict[int, set[int]] = {}
    for node in range(1, nodes):
        waiting.setdefault(len(neighbours[node]), set()).add(node)
    order: list[int] = []
    for _ in range(1, nodes):
        degree = min(key for key, group in waiting.items() if group)
        node = min(waiting[degree])
        waiting[degree].discard(node)
        order += [3 * (node - 1) + k for k in range(3)]
        around = sorted(neighbours[node])
        for other in around:
            waiting[len(neighbours[other])].discard(other)
            neighbours[other].discard(node)
            neighbours[other].update(k for k in around if k != other)
            waiting.setdefault(len(neighbours[other]), set()).add(other)
    return order


def _solve(rows: list[Row], right: list[float], order: list[int], damping: float) -> list[float]:
    """Return the solution of symmetric positive definite equations: each pivot is eliminated from its neighbours."""
    rows = [dict(row) for row in rows]
    right = list(right)
    for i, row in enumerate(rows):
        row[i] = row.get(i, 0.0) * (1.0 + damping) + 1e-9
    for pivot in order:
        row = rows[pivot]
        diagonal = row.pop(pivot)
        row[-1] = diagonal  # for the substitution
        others = [(k, value) for k, value in row.items() if k >= 0]
        for i, value in others:
            factor = value / diagonal
            target = rows[i]
            del target[pivot]
            right[i] -= factor * right[pivot]
            for j, entry in others:
                target[j] = target.get(j, 0.0) - factor * entry
    solution = [0.0] * len(rows)
    for pivot in reversed(order):
        row = rows[pivot]
        total = right[pivot]
        for k, value in row.items():
            if k >= 0:
                total -= value * solution[k]
        solution[pivot] = total / row[-1]
    return solution
