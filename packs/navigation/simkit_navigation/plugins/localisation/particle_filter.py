"""Adaptive Monte Carlo localisation: weights, resampling with an adaptive number of particles, and the estimate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit_navigation.plugins.localisation.likelihood_field import Poses
from simkit_navigation.plugins.localisation.motion_models import wrapped_angles

Weights = npt.NDArray[np.float64]
RandomPoses = Callable[[int], Poses]

_CELL: Final = np.array([0.5, 0.5, math.radians(10.0)])  # sides of a cell of the histogram [m, m, rad]
_HEADINGS: Final = 36  # cells around
_AROUND: Final = np.array(
    [(x, y, a) for x in (-1, 0, 1) for y in (-1, 0, 1) for a in (-1, 0, 1) if (x, y, a) > (0, 0, 0)]
)  # half of the neighbours of a cell


@dataclass(frozen=True)
class Adaptation:
    """Parameters of the number of particles and of the recovery.

    Attributes:
        least, most: bounds of the number of particles.
        error: largest error between the true distribution and the particles (Kullback-Leibler distance).
        quantile: upper quantile of the standard normal distribution for the probability that the error is kept.
        slow, fast: rates of two averages of the agreement of scans and map; 0 for no recovery. While the fast average
            is below the slow one, random particles are added.
    """

    least: int
    most: int
    error: float
    quantile: float
    slow: float
    fast: float

    def needed(self, cells: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
        """Return the number of particles for numbers of occupied cells of the histogram (Fox: KLD-sampling, 2003)."""
        k = np.maximum(cells - 1, 1)
        b = 2.0 / (9.0 * k)
        root = 1 - b + np.sqrt(b) * self.quantile
        count = np.ceil(k / (2 * self.error) * (root * root * root))
        sizes: npt.NDArray[np.float64] = np.clip(np.where(cells <= 1, self.least, count), self.least, self.most)
        return sizes


@dataclass(frozen=True)
class Estimate:
    """Pose of the robot.

    Attributes:
        pose: x, y [m] and yaw [rad].
        covariance: covariance of the pose, shape (3, 3).
        share: weight of the particles of the estimate, 0 to 1.
    """

    pose: tuple[float, float, float]
    covariance: Poses
    share: float


@dataclass
class ParticleFilter:
    """Particles with weights.

    Attributes:
        poses: poses of the particles.
        weights: weights of the particles; their sum is 1.
        slow, fast: averages of the agreement of scans and map for the recovery; 0 before the first scan.
        scans: number of scans in the averages.
    """

    poses: Poses
    weights: Weights
    slow: float = 0.0
    fast: float = 0.0
    scans: int = 0

    @classmethod
    def of(cls, poses: Poses) -> ParticleFilter:
        """Return a filter whose particles have equal weights."""
        return cls(poses, np.full(len(poses), 1.0 / len(poses)))

    def restart(self, poses: Poses) -> None:
        """Replace the particles; the averages stay, so that particles at a wrong place are noticed."""
        self.poses, self.weights = poses, np.full(len(poses), 1.0 / len(poses))

    def weigh(self, likelihoods: Weights, agreements: Weights, adaptation: Adaptation) -> None:
        """Multiply the weights by the likelihoods of a scan.

        Args:
            likelihoods: likelihood of the scan for each particle, up to a factor.
            agreements: how well the scan agrees with the map, on the same scale for all scans; for the recovery.
            adaptation: rates of the two averages.
        """
        agreement = float(matmul(self.weights, agreements))
        self.scans += 1
        # plain means at first: the agreement is low while the particles are everywhere, and must not be the standard
        self.slow += max(adaptation.slow, 1 / self.scans) * (agreement - self.slow)
        self.fast += max(adaptation.fast, 1 / self.scans) * (agreement - self.fast)
        weights = self.weights * likelihoods
        total = float(weights.sum())
        # a total of 0: no particle explains the scan
        self.weights = weights / total if total > 0.0 else np.full(len(weights), 1.0 / len(weights))

    def resample(
        self, adaptation: Adaptation, random_poses: RandomPoses | None, generator: np.random.Generator
    ) -> None:
        """Draw particles by their weights until there are enough for the cells that they occupy.

        Args:
            adaptation: number of particles and recovery.
            random_poses: function that returns any poses; None if the map has no free cells, so that none are added.
            generator: random numbers.
        """
        most = adaptation.most
        bounds = np.cumsum(self.weights)
        drawn = np.searchsorted(bounds / bounds[-1], generator.random(most), side="right")
        poses = self.poses[np.minimum(drawn, len(self.poses) - 1)]
        lost = 1.0 - self.fast / self.slow if self.slow > 0 else 0.0
        if lost > 0.0 and random_poses is not None:
            is_random = generator.random(most) < lost
            poses[is_random] = random_poses(int(is_random.sum()))
        _, first = np.unique(_cells(poses)[1], return_index=True)
        is_new = np.zeros(most, np.int64)
        is_new[first] = 1
        enough = np.arange(1, most + 1) >= adaptation.needed(np.cumsum(is_new))
        count = int(np.argmax(enough)) + 1 if enough.any() else most
        self.poses = poses[:count]
        self.weights = np.full(count, 1.0 / count)

    def estimate(self) -> Estimate:
        """Return the mean of the heaviest cluster of particles; clusters are connected cells of the histogram."""
        groups = _clusters(self.poses)
        shares = np.bincount(groups, self.weights)
        best = int(np.argmax(shares))
        inside = groups == best
        poses, weights = self.poses[inside], self.weights[inside] / shares[best]
        mean = matmul(weights, poses[:, :2])
        cos, sin = float(matmul(weights, np.cos(poses[:, 2]))), float(matmul(weights, np.sin(poses[:, 2])))
        yaw = math.atan2(sin, cos)
        offsets = np.column_stack((poses[:, :2] - mean, wrapped_angles(poses[:, 2] - yaw)))
        covariance = matmul((offsets * weights[:, None]).T, offsets)
        return Estimate((float(mean[0]), float(mean[1]), yaw), covariance, float(shares[best]))


def _cells(poses: Poses) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], int]:
    """Return cell and number of the cell of each pose, and how far apart the numbers of neighbours along x are.

    The cells have a border of one cell along x and y, so that no neighbour of a cell has the number of another cell.
    """
    cells = np.floor(poses / _CELL).astype(np.int64)
    cells[:, :2] -= cells[:, :2].min(axis=0) - 1
    cells[:, 2] %= _HEADINGS
    rows = int(cells[:, 1].max()) + 2
    return cells, _numbers(cells, rows), rows


def _numbers(cells: npt.NDArray[np.int64], rows: int) -> npt.NDArray[np.int64]:
    numbers: npt.NDArray[np.int64] = (cells[..., 0] * rows + cells[..., 1]) * _HEADINGS + cells[..., 2]
    return numbers


def _clusters(poses: Poses) -> npt.NDArray[np.int64]:
    """Return the number of the cluster of each pose."""
    cells, numbers, rows = _cells(poses)
    known, first, inverse = np.unique(numbers, return_index=True, return_inverse=True)
    around = cells[first][:, None] + _AROUND
    around[..., 2] %= _HEADINGS
    wanted = _numbers(around, rows)
    at = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    begins, ways = np.nonzero(known[at] == wanted)
    groups = list(range(len(known)))  # each cell refers to an earlier cell of its cluster, or to itself

    def first_of(cell: int) -> int:
        while groups[cell] != cell:
            groups[cell] = cell = groups[groups[cell]]
        return cell

    for cell_a, other in zip(begins.tolist(), at[begins, ways].tolist(), strict=True):
        a, b = first_of(cell_a), first_of(other)
        groups[max(a, b)] = min(a, b)
    clusters: npt.NDArray[np.int64] = np.array([first_of(cell) for cell in groups])[inverse]
    return clusters
