"""Designs of sweeps: the values and the seed of each run, computed in blocks so that a sweep needs little memory."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import Final, Literal

import numpy as np
import numpy.typing as npt

from simkit_learning.sweeps.parameter_space import ParameterSpace, ParameterValue, Values

Points = npt.NDArray[np.float64]

Sampling = Literal["random", "sobol", "latin_hypercube", "saltelli"]
"""Placement of the samples of distributions.

- "random": independent points.
- "sobol": points of a scrambled Sobol sequence; best with a power of two.
- "latin_hypercube": each of N equal parts of each parameter's range has one of the N points.
- "saltelli": N·(d + 2) points for d parameters, from which a report computes Sobol indices.
"""

SAMPLINGS: Final = ("random", "sobol", "latin_hypercube", "saltelli")
_CHUNK: Final = 1024  # number of random or Sobol points that are computed together


@dataclass(frozen=True)
class SweepRow:
    """One run of a sweep.

    Attributes:
        run: number of the run, from 0.
        seed: seed of its noise.
        values: values of its parameters by name.
    """

    run: int
    seed: int
    values: Values


@dataclass(frozen=True)
class Design:
    """Values and seeds of all runs of a sweep.

    The runs are ordered by sample, then by combination of listed values, then by seed. Without `samples`, each seed
    has a sample of its own.

    Attributes:
        spaces: spaces of the parameters; listed values are combined with each other and with each sample.
        seeds: seeds; each combination of values runs once with each seed.
        samples: number of samples of the distributions; None for one sample a seed.
        sampling: placement of the samples.
        design_seed: seed of the samples. It is independent of the seeds of the runs.
        listed: values of each run by name, instead of samples; None for none.
    """

    spaces: tuple[ParameterSpace, ...]
    seeds: tuple[int, ...] | range = (0,)
    samples: int | None = None
    sampling: Sampling = "random"
    design_seed: int = 0
    listed: tuple[Values, ...] | None = None

    @cached_property
    def grids(self) -> tuple[ParameterSpace, ...]:
        """Spaces of listed values."""
        return tuple(space for space in self.spaces if space.levels is not None)

    @cached_property
    def distributions(self) -> tuple[ParameterSpace, ...]:
        """Spaces of sampled values."""
        return tuple(space for space in self.spaces if space.levels is None)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters."""
        listed = dict.fromkeys(name for row in self.listed or () for name in row)
        return (*listed, *(name for space in self.spaces for name in space.names))

    @cached_property
    def dimensions(self) -> int:
        """Number of sampled parameters."""
        return sum(len(space.names) for space in self.distributions)

    @cached_property
    def combinations(self) -> int:
        """Number of combinations of listed values."""
        return math.prod(len(space.levels or ()) for space in self.grids)

    @cached_property
    def points(self) -> int:
        """Number of samples, or of rows of a list."""
        if self.listed is not None:
            return len(self.listed)
        if not self.distributions:
            return 1
        count = len(self.seeds) if self.samples is None else self.samples
        return count * (self.dimensions + 2) if self.sampling == "saltelli" else count

    @property
    def is_paired(self) -> bool:
        """True if each seed has a sample of its own."""
        return bool(self.distributions) and self.samples is None and self.listed is None

    @cached_property
    def count(self) -> int:
        """Number of runs."""
        return self.points * self.combinations * (1 if self.is_paired else len(self.seeds))

    def row(self, run: int) -> SweepRow:
        """Return one run."""
        seeds = 1 if self.is_paired else len(self.seeds)
        rest, of_seed = divmod(run, seeds)
        point, combination = divmod(rest, self.combinations)
        values: dict[str, ParameterValue] = {}
        if self.listed is not None:
            values.update(self.listed[point])
        elif self.distributions:
            values.update(self._sampled(point))
        for space in reversed(self.grids):
            assert space.levels is not None
            combination, level = divmod(combination, len(space.levels))
            values[space.names[0]] = space.levels[level]
        ordered = {name: values[name] for name in self.names if name in values}
        return SweepRow(run, self.seeds[point if self.is_paired else of_seed], ordered)

    def rows(self, runs: Sequence[int] | range) -> Iterator[SweepRow]:
        """Yield several runs."""
        return map(self.row, runs)

    def _sampled(self, point: int) -> dict[str, ParameterValue]:
        unit: list[float] = self._unit_point(point).tolist()
        values: dict[str, ParameterValue] = {}
        at = 0
        for space in self.distributions:
            values.update(space.values(unit[at : at + len(space.names)]))
            at += len(space.names)
        return values

    def _unit_point(self, point: int) -> Points:
        """Return a point between 0 and 1, shape (dimensions,)."""
        count, dimensions = self.points, self.dimensions
        if self.sampling == "latin_hypercube":
            points: Points = _latin_hypercube(count, dimensions, self.design_seed)
            return np.asarray(points[point])
        if self.sampling != "saltelli":
            make = _sobol if self.sampling == "sobol" else _random
            return np.asarray(make(dimensions, self.design_seed, point // _CHUNK)[point % _CHUNK])
        matrix, at = divmod(point, count // (dimensions + 2))
        both = _sobol(2 * dimensions, self.design_seed, at // _CHUNK)[at % _CHUNK]
        mixed = both[dimensions:].copy() if matrix == 1 else both[:dimensions].copy()
        if matrix > 1:  # the point of matrix A with one coordinate of matrix B
            mixed[matrix - 2] = both[dimensions + matrix - 2]
        return np.asarray(mixed)


@cache
def _latin_hypercube(count: int, dimensions: int, seed: int) -> Points:
    from scipy.stats import qmc

    points: Points = qmc.LatinHypercube(dimensions, seed=np.random.default_rng(seed)).random(count)
    return points


@lru_cache(maxsize=8)
def _random(dimensions: int, seed: int, chunk: int) -> Points:
    return np.random.default_rng((seed, chunk)).random((_CHUNK, dimensions))


@lru_cache(maxsize=8)
def _sobol(dimensions: int, seed: int, chunk: int) -> Points:
    from scipy.stats import qmc

    sequence = qmc.Sobol(dimensions, scramble=True, seed=np.random.default_rng(seed))
    if chunk:
        sequence.fast_forward(chunk * _CHUNK)
    points: Points = sequence.random(_CHUNK)
    return points
