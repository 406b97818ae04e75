"""Biases that drift: first-order Gauss-Markov processes and random walks, exact for any interval between samples.

A Gauss-Markov process `db = -b/T dt + K dW` goes from one sample to the next by `b = φ·b + s·n` with
`φ = exp(-dt/T)`, `s² = K²·T/2·(1 - exp(-2·dt/T))` and a standard normal n. With an infinite T the process is a random
walk, `φ = 1`, `s² = K²·dt`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.elementary_functions import exp, expm1
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.runtime.engine.random_streams import RandomStreams

ALLAN_FLOOR: Final = math.sqrt(2.0 * math.log(2.0) / math.pi)
"""Ratio of flicker noise's Allan deviation to its coefficient B, 0.664 (IEEE Std 952-1997, annex C)."""

ALLAN_PEAK: Final = 0.6174
"""Greatest Allan deviation of a Gauss-Markov process over its standard deviation, at 1.89 times its correlation time.

The Allan variance at x = (averaging time)/T is 2σ²/x·(1 - (3 - 4·e^-x + e^-2x)/(2x)). The same annex gives the peak as
0.437·K·√T with σ² = K²·T/2.
"""

FLICKER_TIMES: Final = tuple(10.0**k for k in range(-1, 5))
"""Correlation times [s] of the processes whose sum has a constant Allan deviation from 1 s to 1000 s, within 2.5 %."""

_MIN_TIME: Final = 1e-100  # [s] shortest correlation time; below any time step the process is white noise


@dataclass(frozen=True, slots=True)
class BiasDrift:
    """Drifting bias of one kind on several channels, as one or more Gauss-Markov processes per channel.

    Attributes:
        driving: driving noise K [unit/√s], shape (processes · channels,), ordered by process; 0 for no bias.
        time: correlation time T [s], same shape; infinite for a random walk.
        initial_stddev: standard deviation of the initial value, same shape; with 0, the bias starts at zero.
        name: name of the random stream within the group.
        processes: number of processes per channel.
    """

    driving: Vector
    time: Vector
    initial_stddev: Vector
    name: str
    processes: int = 1

    def factors(self, dt: float) -> tuple[Vector, Vector]:
        """Return φ and s of a step of `dt` [s]."""
        # T·(1 - exp(-2dt/T)) would lose digits for a long correlation time, expm1 does not
        with np.errstate(invalid="ignore", over="ignore"):
            exponent = -dt / self.time
            variance_time = np.where(np.isfinite(self.time), -0.5 * self.time * expm1(2.0 * exponent), dt)
        return exp(exponent), self.driving * np.sqrt(variance_time)

    @property
    def is_idle(self) -> bool:
        """True if no channel has this bias."""
        return not self.driving.any()


def gauss_markov_drift(driving: Sequence[float], times: Sequence[float], name: str) -> BiasDrift:
    """Return a bias with one Gauss-Markov process per channel, which starts at zero.

    Args:
        driving: K of each channel [unit/√s].
        times: T of each channel [s]; 0 is a random walk.
        name: name of the random stream.
    """
    time = np.array(times, dtype=np.float64)
    time[time <= 0] = np.inf
    return BiasDrift(np.array(driving, dtype=np.float64), time, np.zeros(len(driving)), name)


def instability_drift(coefficients: Sequence[float], times: Sequence[float], name: str) -> BiasDrift:
    """Return a bias with the instability B [unit] of each channel, in its steady state from the start.

    With a correlation time T [s], one Gauss-Markov process represents the instability. Its Allan deviation has
    its peak, 0.664·B, at 1.89·T. Without T, the bias is flicker noise with 0.664·B from 1 s to 1000 s. Flicker
    noise is the sum of one process per decade of correlation times, each of variance B²·ln(10)/π. Their
    densities, 2σ²T/(1 + (ωT)²), add up to B²/(2πf), which IEEE Std 952-1997 defines as bias instability.

    Args:
        coefficients: B of each channel [unit].
        times: T of each channel [s]; 0 is flicker noise.
        name: name of the random stream.
    """
    amplitude = np.array(coefficients, dtype=np.float64)
    single = np.array(times, dtype=np.float64) > 0
    rows = len(FLICKER_TIMES) if bool(((amplitude > 0) & ~single).any()) else 1
    time = np.tile(np.array(FLICKER_TIMES[:rows])[:, None], (1, len(amplitude)))
    spread = np.tile(amplitude * math.sqrt(math.log(10.0) / math.pi), (rows, 1))
    for channel in np.flatnonzero(single).tolist():
        time[:, channel] = max(times[channel], _MIN_TIME)
        spread[:, channel] = 0.0
        spread[0, channel] = amplitude[channel] * ALLAN_FLOOR / ALLAN_PEAK
    return BiasDrift((spread * np.sqrt(2.0 / time)).ravel(), time.ravel(), spread.ravel(), name, rows)


@dataclass(slots=True)
class NoiseInterval:
    """Constants of the noise for one interval between two samples, computed once per interval.

    Attributes:
        stddev: standard deviation of the white noise, shape (channels,).
        factors: φ and s of each drifting bias.
        covariances: covariances computed so far, by first channel.
    """

    stddev: Vector
    factors: tuple[tuple[Vector, Vector], ...] = ()
    covariances: dict[int, Vector] = field(default_factory=dict)


class NoiseState:
    """State of a sensor's noise at one sample. Each sample gets a new object, and no object is modified.

    Attributes:
        interval: standard deviation and drift factors for the time since the previous sample.
        biases: current values of each drifting bias.
        constant: sum of all noise except white noise, shape (channels,).
    """

    __slots__ = ("_numbers", "biases", "constant", "interval")

    def __init__(self, interval: NoiseInterval, biases: tuple[Vector, ...], constant: Vector) -> None:
        self.interval, self.biases, self.constant = interval, biases, constant
        self._numbers: tuple[list[float], list[float]] | None = None

    @property
    def numbers(self) -> tuple[list[float], list[float]]:
        """`constant` and the standard deviation of the white noise, as two lists of numbers."""
        if self._numbers is None:
            self._numbers = self.constant.tolist(), self.interval.stddev.tolist()
        return self._numbers

    def __deepcopy__(self, memo: object) -> NoiseState:
        return self


class BiasDriftGenerator:
    """Generator of the steps of drifting biases.

    Args:
        drifts: drifting biases; a bias that no channel has is left out.
        streams: random streams of the simulation.
        scoped, group: scoped name of the sensor and name of the noise group; together they name the streams.
    """

    def __init__(self, drifts: Sequence[BiasDrift], streams: RandomStreams, scoped: str, group: str) -> None:
        self.drifts = tuple(drift for drift in drifts if not drift.is_idle)
        self._streams = [streams.stream(scoped, f"{group}/{drift.name}", drift.driving.size) for drift in self.drifts]

    def begin(self) -> tuple[Vector, ...]:
        """Return the initial values of all biases, in the form of `NoiseState.biases`."""
        return tuple(
            drift.initial_stddev * stream.normal(0) if drift.initial_stddev.any() else drift.initial_stddev
            for drift, stream in zip(self.drifts, self._streams, strict=True)
        )

    def factors(self, dt: float) -> tuple[tuple[Vector, Vector], ...]:
        return tuple(drift.factors(dt) for drift in self.drifts)

    def step(
        self, biases: tuple[Vector, ...], factors: tuple[tuple[Vector, Vector], ...], index: int
    ) -> tuple[Vector, ...]:
        """Return the values of all biases at sample `index`, one interval after the values `biases`."""
        moved = []
        for i, stream in enumerate(self._streams):
            decay, spread = factors[i]
            step = spread * stream.normal(index)
            step += decay * biases[i]
            moved.append(step)
        return tuple(moved)

    def sums(self, biases: tuple[Vector, ...]) -> list[Vector]:
        """Return the sum of each bias's processes, shape (channels,)."""
        return [
            part if drift.processes == 1 else np.add.reduce(part.reshape(drift.processes, -1))
            for drift, part in zip(self.drifts, biases)  # noqa: B905 - runs at every sample, and strict costs time
        ]
