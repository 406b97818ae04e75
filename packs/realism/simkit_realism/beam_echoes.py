"""Echoes of a beam with a footprint: surfaces that the parts of the beam hit, as far as the receiver separates them."""

from __future__ import annotations

import math

import numpy as np

from simkit.extend import Vector
from simkit_realism.optical_rays import Returns


def beam_directions(axes: Vector, divergence: float, rings: int) -> Vector:
    """Return the directions of the parts of beams around their axes, shape (k · n, 3), part by part.

    Ring j of m has 6·j parts, so that each of the 1 + 3·m·(m + 1) parts, the axis among them, has the same solid angle.

    Args:
        axes: unit vectors of the beams, shape (n, 3).
        divergence: full angle of the cone with all the light [rad].
        rings: number m of rings around the axis.
    """
    sides = np.stack((-axes[:, 1], axes[:, 0], np.zeros(len(axes))), axis=1)
    length = np.sqrt(sides[:, 0] * sides[:, 0] + sides[:, 1] * sides[:, 1])[:, None]
    sides = np.where(length > 1e-6, sides / np.maximum(length, 1e-6), (0.0, 1.0, 0.0))
    ups = np.stack([axes[:, (i + 1) % 3] * sides[:, (i + 2) % 3] - axes[:, (i + 2) % 3] * sides[:, (i + 1) % 3]
                    for i in range(3)], axis=1)  # fmt: skip
    count = 1 + 3 * rings * (rings + 1)
    parts = []
    for j in range(1, rings + 1):
        inner, outer = 1 + 3 * (j - 1) * j, 1 + 3 * j * (j + 1)
        angle = 0.5 * divergence * math.sqrt(0.5 * (inner + outer) / count)
        for i in range(6 * j):
            turn = math.pi * i / (3 * j)
            across = math.sin(angle) * (math.cos(turn) * sides + math.sin(turn) * ups)
            parts.append(math.cos(angle) * axes + across)
    return np.concatenate(parts)


class EchoList:
    """First, last, strongest and second strongest echo of each beam.

    Parts whose ranges differ by less than the resolution from the next one form one echo. Its range is the mean of its
    parts, weighted by their strengths, or that of the nearest part.

    Args:
        parts: returns of all parts of the beams, part by part: shape (k · n,).
        count: number n of beams.
        resolution: least distance between surfaces that the receiver separates [m].
        is_nearest: True for the range of the nearest part, False for the mean.
    """

    def __init__(self, parts: Returns, count: int, resolution: float, is_nearest: bool) -> None:
        self._parts, self._count, self._is_nearest = parts, count, is_nearest
        ranges = parts.ranges.reshape(-1, count)
        self._size = len(ranges)
        order = np.argsort(ranges, axis=0, kind="stable")
        self._rows = order * count + np.arange(count)  # numbers of the parts, by ascending range
        strengths = np.where(np.isfinite(parts.ranges), parts.strengths, 0.0)
        self.first, self.last = _Echoes(count), _Echoes(count)
        self.strongest, self.second = _Echoes(count), _Echoes(count)
        present, before = _Echoes(count), np.full(count, -np.inf)
        for rows in self._rows:
            distance, strength = parts.ranges.take(rows), strengths.take(rows)
            is_hit = np.isfinite(distance)
            begins = is_hit & (np.where(is_hit, distance, 0.0) - before > resolution)
            self._end(present, begins)
            present.clear(begins)
            present.add(is_hit, rows, distance, strength, self._shares(rows))
            before = np.where(is_hit, distance, before)
        self._end(present, np.full(count, True))

    def _shares(self, rows: np.ndarray) -> Vector:
        shares: Vector = self._parts.reflectivities.take(rows) * self._parts.cosines.take(rows) / self._size
        return shares

    def _end(self, echo: _Echoes, ends: np.ndarray) -> None:
        """Enter complete echoes in the lists; an echo without a part is none."""
        ends = ends & (echo.part >= 0)
        is_stronger = ends & (echo.energy > self.strongest.energy)
        is_second = ends & ~is_stronger & (echo.energy > self.second.energy)
        self.second.copy(is_stronger, self.strongest)
        self.second.copy(is_second, echo)
        self.strongest.copy(is_stronger, echo)
        self.first.copy(ends & (self.first.part < 0), echo)
        self.last.copy(ends, echo)

    def returns(self, echoes: _Echoes) -> Returns:
        """Return echoes as returns; their reflectivity is the share of the whole beam's light."""
        found = self._parts.take(np.maximum(echoes.part, 0))
        is_missing = echoes.part < 0
        ranges = echoes.nearest if self._is_nearest else echoes.moment / np.maximum(echoes.energy, 1e-300)
        found.ranges = np.where(is_missing, np.inf, ranges)
        found.geoms = np.where(is_missing, -1, found.geoms)
        found.cosines = np.where(is_missing, 0.0, found.cosines)
        found.reflectivities = echoes.share / np.maximum(found.cosines, 1e-6)
        return found


class _Echoes:
    """One echo of each beam.

    Attributes:
        energy: sum of the strengths of its parts.
        moment: sum of the strengths times the ranges.
        nearest: range of the nearest part [m].
        share: share of the beam's light that returns: mean of ρ·cos(θ) over all parts of the beam.
        part: number of the strongest part; -1 for no echo.
        peak: strength of that part.
    """

    __slots__ = ("energy", "moment", "nearest", "part", "peak", "share")

    def __init__(self, count: int) -> None:
        self.energy, self.moment, self.share, self.peak = (np.zeros(count) for _ in range(4))
        self.nearest, self.part = np.full(count, np.inf), np.full(count, -1)

    def clear(self, which: np.ndarray) -> None:
        """Begin new echoes."""
        for values in (self.energy, self.moment, self.share, self.peak):
            values[which] = 0.0
        self.nearest[which], self.part[which] = np.inf, -1

    def add(self, which: np.ndarray, rows: np.ndarray, ranges: Vector, strengths: Vector, shares: Vector) -> None:
        """Add a part to some echoes."""
        strengths = np.where(which, np.maximum(strengths, 1e-12), 0.0)  # a black surface still has a place
        self.energy += strengths
        self.moment += strengths * np.where(which, ranges, 0.0)
        self.share += np.where(which, shares, 0.0)
        self.nearest = np.where(which & (self.part < 0), ranges, self.nearest)
        is_peak = which & (strengths > self.peak)
        self.part, self.peak = np.where(is_peak, rows, self.part), np.where(is_peak, strengths, self.peak)

    def copy(self, which: np.ndarray, other: _Echoes) -> None:
        """Copy some echoes."""
        for name in self.__slots__:
            np.copyto(getattr(self, name), getattr(other, name), where=which)
