"""Noise of IMUs: Allan deviation of the still robot, and covariances of the white noise."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from typing import Final

import numpy as np

from simkit.testing.run_record.noise_statistics import NoiseStatistics, noise_statistics
from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import Floats, Signal, Stream
from simkit_identification.measures.signals import is_constant, quiet_part, second_differences

_INSTABILITY: Final = 0.664  # Allan deviation of a flicker noise, relative to its bias instability (IEEE Std 952)
_LARGEST_ERROR: Final = 0.1  # relative; the lowest of less certain deviations is too low by chance
_LEAST: Final = 200  # samples for an Allan deviation
_SHOCK: Final = 40.0  # product of two noises, relative to the median, that is a shock
_RANDOM_WALK: Final = {"rad/s": ("angle random walk", "rad/√s"), "m/s²": ("velocity random walk", "m/s/√s")}
VECTORS: Final = ("angular_velocity", "linear_acceleration", "magnetic_field")


def still_statistics(signal: Signal, context: Context) -> NoiseStatistics | None:
    """Return the noise statistics of a signal while the robot is still; None if it is still for too short a time."""
    part = quiet_part(signal, context)
    is_still = context.still is None or len(part.values) < len(signal.values)
    if not is_still or len(part.values) < _LEAST or np.ptp(part.values) == 0.0:
        return None
    return noise_statistics(part.values, float(np.median(np.diff(part.times))))


def allan(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield random walk and bias instability of each axis."""
    for name, signal in stream.signals.items():
        if not name.startswith(VECTORS) or signal.is_setting or is_constant(signal):
            continue
        statistics = still_statistics(signal, context)
        if statistics is None or len(statistics.taus) < 3:
            stream.notes.append("the robot is not still for long enough for an Allan deviation")
            return
        taus, deviations = statistics.taus, statistics.allan[0]
        errors = np.sqrt(taus / taus[0] / statistics.count)  # of the logarithm
        if signal.unit in _RANDOM_WALK:
            quantity, unit = _RANDOM_WALK[signal.unit]
            at = _white_part(taus, deviations)
            walk = float(deviations[at]) * math.sqrt(float(taus[at]))
            yield Measure(f"{quantity} of {name}", unit, "estimate", np.array([walk, walk * float(errors[at])]))
        certain = errors <= _LARGEST_ERROR
        lowest = int(np.argmin(deviations[certain]))
        value = float(deviations[lowest]) / _INSTABILITY
        # the minimum is chosen among several values, so its error is that of the longest averages
        error = value * float(errors[certain][-1])
        yield Measure(f"bias instability of {name}", signal.unit, "estimate", np.array([value, error]))


def _white_part(taus: Floats, deviations: Floats) -> int:
    """Return the index of the averaging time at which the noise is white.

    This is the shortest time, unless the deviation falls there less or more than white noise does (filtered or rounded
    readings). It is then the time next to 1 s.
    """
    fall = math.log(float(deviations[2] / deviations[0])) / math.log(float(taus[2] / taus[0]))
    return 0 if abs(fall + 0.5) < 0.15 else int(np.argmin(np.abs(taus - 1.0)))


def covariances(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield the covariances of the white noise of two axes."""
    if not stream.is_periodic or stream.count < 20:
        return
    for vector in VECTORS:
        signals = {axis: stream.signals.get(f"{vector}.{axis}") for axis in "xyz"}
        rows = {
            k: second_differences(quiet_part(s, context))
            for k, s in signals.items()
            if s is not None and not is_constant(s)
        }
        for one, two in combinations(sorted(rows), 2):
            if len(rows[one]) == len(rows[two]):
                signal = signals[one]
                unit = f"({signal.unit})²" if signal is not None else ""
                product = rows[one] * rows[two] / 6.0
                limit = _SHOCK * float(np.median(np.abs(product)))
                product = np.clip(product, -limit, limit)
                yield Measure(f"noise covariance {one}{two} of {vector}", unit, "mean", product)
