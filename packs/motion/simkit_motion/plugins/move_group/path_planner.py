"""Collision-free paths of a group of joints: RRT-Connect and shortcuts.

J. Kuffner, S. LaValle: "RRT-Connect: An efficient approach to single-query path planning", ICRA 2000. Two trees grow

from the start and from the goals towards random positions and towards each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import matmul
from simkit_motion.plugins.move_group.group_model import GroupModel
from simkit_motion.plugins.move_group.inverse_kinematics import finite_limits

_STEP: Final = 0.5  # [m], longest way of any point of the robot in one extension of a tree
_SHORTCUTS: Final = 60  # number of tried shortcuts


class BudgetSpent(Exception):
    """Error: the number of collision checks is used up."""


class PathPlanner:
    """Planner for one request.

    Args:
        model: Model of the group, with its collision model.
        random: Source of random positions.
        margin: Distance that the collision model keeps [m]. Two checked positions between which no point moves further
            than twice this distance have no collision between them.
        budget: Largest number of collision checks.

    Attributes:
        checks: Number of collision checks so far.
    """

    def __init__(self, model: GroupModel, random: np.random.Generator, margin: float, budget: int) -> None:
        self._model, self._random, self._budget = model, random, budget
        self._spacing = 2.0 * max(margin, 1e-3)
        self._low, self._high = finite_limits(model)
        self.checks = 0

    def plan(self, start: Vector, goals: Sequence[Vector]) -> list[Vector]:
        """Return positions from the start to one of the goals, connected by straight lines.

        The start and the goals must be free of collisions; the first goals are preferred.

        Raises:
            BudgetSpent: No path was found with the number of checks.
        """
        for goal in goals:
            if self.is_line_free(start, goal):
                return [start, goal]
        forward, backward = _Tree(self._model.levers, [start]), _Tree(self._model.levers, goals)
        grown, other = forward, backward
        while True:
            reached = self._extend(grown, self._random.uniform(self._low, self._high), steps=1)
            if reached is not None:
                target = grown.nodes[reached]
                met = self._extend(other, target, steps=10_000)
                if met is not None and np.array_equal(other.nodes[met], target):
                    ways = {id(grown): grown.branch(reached), id(other): other.branch(met)}
                    return [*ways[id(forward)][::-1], *ways[id(backward)][1:]]
            grown, other = other, grown

    def _extend(self, tree: _Tree, target: Vector, steps: int) -> int | None:
        """Extend a tree towards a target and return the last new node, or the node at the target; None if blocked."""
        index, last = tree.nearest(target), None
        for _ in range(steps):
            here = tree.nodes[index]
            away = float(matmul(self._model.levers, np.abs(target - here)))
            if away == 0.0:
                return index
            there = target if away <= _STEP else here + (target - here) * (_STEP / away)
            if not self.is_line_free(here, there):
                break
            last = index = tree.add(there, index)
        return last

    def is_line_free(self, start: Vector, end: Vector) -> bool:
        """Check whether nothing collides on the straight line between two positions, except at its start.

        Raises:
            BudgetSpent: The number of checks is used up.
        """
        length = float(matmul(self._model.levers, np.abs(end - start)))
        count = max(1, int(np.ceil(length / self._spacing)))
        order = np.arange(1, count + 1)
        if count > 2:  # collisions are likely in the middle and at the end
            order = np.concatenate([order[::-4], order[-2::-4], order[-3::-4], order[-4::-4]])
        for k in order:
            if self.checks >= self._budget:
                raise BudgetSpent
            self.checks += 1
            if not self._model.is_free(start + (end - start) * (k / count)):
                return False
        return True

    def shorten(self, path: Sequence[Vector]) -> list[Vector]:
        """Return a shorter path: pairs of its points are connected by straight lines where nothing collides."""
        path = self._without_detours(list(path))
        try:
            for _ in range(_SHORTCUTS):
                if len(path) < 3:
                    return path
                lengths = [float(matmul(self._model.levers, np.abs(b - a))) for a, b in pairwise(path)]
                ends = np.concatenate([[0.0], np.cumsum(lengths)])
                first, second = np.sort(self._random.uniform(0.0, ends[-1], 2))
                i, a = self._at(path, ends, first)
                j, b = self._at(path, ends, second)
                if i != j and self.is_line_free(a, b):
                    path = [*path[: i + 1], a, b, *path[j + 1 :]]
        except BudgetSpent:
            return path
        return self._without_detours(path)

    def _without_detours(self, path: list[Vector]) -> list[Vector]:
        """Return the path without points that a straight line can skip."""
        shortened, here = [path[0]], 0
        try:
            while here < len(path) - 1:
                following = range(len(path) - 1, here + 1, -1)
                here = next((k for k in following if self.is_line_free(path[here], path[k])), here + 1)
                shortened.append(path[here])
        except BudgetSpent:
            return [*shortened, *path[here + 1 :]]
        return shortened

    def _at(self, path: Sequence[Vector], ends: Vector, length: float) -> tuple[int, Vector]:
        """Return the number of the line, and the point on it, at a length along the path [m]."""
        i = min(int(np.searchsorted(ends, length, side="right")) - 1, len(path) - 2)
        part = (length - ends[i]) / max(ends[i + 1] - ends[i], 1e-12)
        return i, path[i] + (path[i + 1] - path[i]) * part


class _Tree:
    """Tree of positions.

    Attributes:
        nodes: Positions.
    """

    def __init__(self, levers: Vector, roots: Sequence[Vector]) -> None:
        self.nodes = [np.array(root) for root in roots]
        self._levers, self._parents = levers, [-1] * len(roots)
        self._array = np.array(self.nodes)

    def nearest(self, target: Vector) -> int:
        """Return the number of the node that is nearest to a target."""
        away = matmul(np.abs(self._array[: len(self.nodes)] - target), self._levers)
        return int(np.argmin(away))

    def add(self, node: Vector, parent: int) -> int:
        """Add a node and return its number."""
        self.nodes.append(node)
        self._parents.append(parent)
        if len(self.nodes) > len(self._array):  # the array grows by doubling
            self._array = np.concatenate([self._array, np.zeros_like(self._array)])
        self._array[len(self.nodes) - 1] = node
        return len(self.nodes) - 1

    def branch(self, node: int) -> list[Vector]:
        """Return the positions from a node to its root."""
        nodes = []
        while node >= 0:
            nodes.append(self.nodes[node])
            node = self._parents[node]
        return nodes
