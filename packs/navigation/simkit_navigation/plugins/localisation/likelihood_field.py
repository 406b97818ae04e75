"""Likelihood field: how well the end points of laser rays agree with the obstacles of an occupancy map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import msgs
from simkit.elementary_functions import exp, log
from simkit.errors import ArgumentTypeError, ArgumentValueError
from simkit.extend import SharedByCopies
from simkit.linear_algebra import matmul

Poses = npt.NDArray[np.float64]
"""Poses: x, y [m] and yaw [rad], shape (n, 3)."""

Values = npt.NDArray[np.float64]

_LEAST: Final = 1e-30  # likelihood of a ray without random hits
_LEAST_SIDE: Final = 1e-6  # [m] of a cell
_BLOCK: Final = 1 << 15  # end points that are looked up together, so that they stay in the processor's cache


@dataclass(frozen=True)
class Hits:
    """Model of a range measurement.

    Attributes:
        sigma: standard deviation of the distance between an end point and an obstacle [m].
        hit: weight of rays that end at an obstacle of the map.
        rand: weight of rays that end anywhere.
        farthest: distance from an obstacle that is as unlikely as all larger distances [m].
        is_product: True multiplies the likelihoods of the rays; False adds their cubes, as Nav2 does by default.
    """

    sigma: float
    hit: float
    rand: float
    farthest: float
    is_product: bool

    def terms(self, distances: Values) -> Values:
        """Return the terms of rays that end at these distances from an obstacle [m]."""
        share: Values = exp(-(np.minimum(distances, self.farthest) ** 2) / (2 * self.sigma**2))
        likelihood = self.hit * share + self.rand
        terms: Values = log(np.maximum(likelihood, _LEAST)) if self.is_product else likelihood * likelihood * likelihood
        return terms

    def likelihoods(self, means: Values, count: int) -> Values:
        """Return the likelihoods of a scan, up to a factor, from the means of the terms of its rays."""
        return exp(count * (means - means.max())) if self.is_product else 1.0 + count * means

    def agreements(self, means: Values) -> Values:
        """Return how well a ray agrees with the map on average, from 0 on; it does not depend on the number of rays."""
        return exp(means) if self.is_product else means


@dataclass(frozen=True, eq=False)
class LikelihoodMap(SharedByCopies):
    """Map with the distance of each cell to the nearest occupied cell.

    Attributes:
        distances: distance between the centres of a cell and of the nearest occupied cell [m], shape (rows, columns).
        free: rows and columns of the free cells, shape (n, 2).
        resolution: side of a cell [m].
        origin: x, y [m] and yaw [rad] of the corner of row 0 and column 0.
    """

    distances: npt.NDArray[np.float64]
    free: npt.NDArray[np.int64]
    resolution: float
    origin: tuple[float, float, float]

    @classmethod
    def from_message(cls, message: msgs.OccupancyGrid) -> LikelihoodMap | None:
        """Return the map of a `nav_msgs/msg/OccupancyGrid`: cells of 100 are occupied, cells of 0 are free.

        None stands for a message that is not valid: without cells, or with a wrong size, resolution or origin.
        """
        from scipy.ndimage import distance_transform_edt

        info = message.info
        data = np.asarray(message.data, np.int8)
        try:
            at = msgs.pose(info.origin)
        except (ArgumentTypeError, ArgumentValueError):
            return None
        if not data.size or data.size != info.height * info.width or not _LEAST_SIDE <= info.resolution < math.inf:
            return None
        cells = data.reshape(info.height, info.width)
        occupied = cells == 100
        side = float(info.resolution)
        distances = np.full(cells.shape, math.inf)
        if occupied.any():
            distances = distance_transform_edt(~occupied) * side
        origin = float(at.position[0]), float(at.position[1]), float(at.rpy[2])
        return cls(distances, np.argwhere(cells == 0), side, origin)

    def random_poses(self, count: int, generator: np.random.Generator) -> Poses:
        """Return poses that are uniformly distributed over the free cells and over all headings."""
        rows, columns = self.free[generator.integers(len(self.free), size=count)].T
        x, y = (np.stack((columns, rows)) + generator.random((2, count))) * self.resolution
        x0, y0, yaw = self.origin
        cos, sin = math.cos(yaw), math.sin(yaw)
        headings = generator.uniform(-math.pi, math.pi, count)
        return np.column_stack((x0 + cos * x - sin * y, y0 + sin * x + cos * y, headings))

    @cached_property
    def _tables(self) -> dict[Hits, npt.NDArray[np.float32]]:
        return {}

    def _table(self, hits: Hits) -> npt.NDArray[np.float32]:
        """Return the term of each cell in the sum over rays; a border of one cell stands for all places outside."""
        tables = self._tables
        if hits not in tables:
            padded = np.pad(self.distances, 1, constant_values=math.inf)
            tables.clear()  # only a change of a parameter needs another table
            tables[hits] = hits.terms(padded).astype(np.float32)
        return tables[hits]

    def mean_terms(self, poses: Poses, points: Values, hits: Hits) -> Values:
        """Return the mean of the terms of the rays of a scan for each pose.

        Args:
            poses: poses of the robot in the frame of the map.
            points: end points of the rays in the frame of the robot [m], shape (m, 2), m > 0.
            hits: model of the measurement.
        """
        table = self._table(hits)
        rows, columns = table.shape
        flat = table.reshape(-1)
        x0, y0, turn = self.origin
        c, s = math.cos(turn), math.sin(turn)
        dx, dy = poses[:, 0] - x0, poses[:, 1] - y0
        # in cells of the padded table; single precision is exact to 1e-3 cells for maps of 10⁴ cells
        start_x, start_y = (c * dx + s * dy) / self.resolution + 1, (c * dy - s * dx) / self.resolution + 1
        heading = poses[:, 2] - turn
        cos, sin = np.cos(heading), np.sin(heading)
        to_x, to_y = (
            np.column_stack(terms).astype(np.float32) for terms in ((cos, -sin, start_x), (sin, cos, start_y))
        )
        ends = np.vstack((points.T / self.resolution, np.ones(len(points)))).astype(np.float32)
        sums = np.empty(len(poses))
        step = max(1, _BLOCK // len(points))
        for first in range(0, len(poses), step):
            part = slice(first, first + step)
            x, y = matmul(to_x[part], ends), matmul(to_y[part], ends)
            np.clip(x, 0, columns - 1, out=x)
            np.clip(y, 0, rows - 1, out=y)
            cells = y.astype(np.int32)  # 64 bits take three times as long; a map has fewer than 2³¹ cells
            cells *= columns
            cells += x.astype(np.int32)
            sums[part] = flat.take(cells, mode="clip").sum(axis=1)
        return sums / len(points)
