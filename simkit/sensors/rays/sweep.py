"""Sweep of a lidar: the time of each ray within a scan."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from simkit.params import Params
from simkit.pose import Vector

_TURN = 2.0 * math.pi
CLOCKWISE, COUNTERCLOCKWISE = "clockwise", "counterclockwise"


@dataclass(frozen=True, slots=True)
class SweepOptions:
    """The `<sweep>` element of a lidar.

    Attributes:
        duration: time from the first column to the last one [s]; 0 for that of a scanner with one turn in a period.
        is_clockwise: True if the scanner turns from the largest azimuth to the smallest, seen from above.
        firing_offsets: time of each layer after the beginning of its column [s]; empty if all layers fire together.
    """

    duration: float = 0.0
    is_clockwise: bool = False
    firing_offsets: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class RayPattern:
    """Directions and times of the rays of one scan.

    The n rays are c columns of l layers, layer by layer, so that ray i is in column i % c. All rays of a column have
    one time. A pattern in which each ray has its own time has n columns and one layer.

    Attributes:
        directions: unit vectors in the sensor's frame, shape (n, 3).
        times: time of each column after the stamp [s], shape (c,).
    """

    directions: Vector
    times: Vector

    @property
    def ray_times(self) -> Vector:
        """Time of each ray after the stamp [s], shape (n,)."""
        times: Vector = np.tile(self.times, len(self.directions) // max(1, len(self.times)))
        return times


def read_sweep(
    params: Params, block: Params, columns: int, layers: int, angle: float, rate: float
) -> SweepOptions | None:
    """Read the `<sweep>` of a `<sensor>`, or of the `<lidar>` or `<ray>` in it; None for a scan at one instant.

    Args:
        params: the `<sensor>`.
        block: the `<lidar>` or `<ray>`.
        columns: number of rays in a layer.
        layers: number of layers.
        angle: angle between the first ray of a layer and the last [rad].
        rate: update rate [Hz].
    """
    element = params.child("sweep") or block.child("sweep")
    if element is None:
        return None
    holder = params if params.has("sweep") else block
    is_on = (bool(element.children) and not element.value) or holder.boolean("sweep", False)
    duration = element.number("duration", 0.0, minimum=0)
    direction = element.choice("direction", (COUNTERCLOCKWISE, CLOCKWISE), COUNTERCLOCKWISE)
    offsets = element.vector("firing_offsets", layers, ()) if element.has("firing_offsets") else ()
    if not is_on:
        return None
    if any(offset < 0 for offset in offsets):
        element.block("firing_offsets").error(
            "SK-SENSOR-202", "found a negative firing offset; expected times of at least 0 s"
        )
        offsets = ()
    if not rate > 0:
        message = "<sweep> needs the time of a scan, and the sensor has no <update_rate>"
        element.error("SK-SENSOR-200", message, "add an <update_rate>, for example <update_rate>10</update_rate>")
        return None
    options = SweepOptions(duration, direction == CLOCKWISE, offsets)
    length = last_time(options, columns, angle, rate)
    if length > 1.0 / rate * (1 + 1e-9):
        found = f"the scan takes {length:g} s, longer than the period of {1.0 / rate:g} s at {rate:g} Hz"
        help_ = "a shorter <duration>, or a lower <update_rate>"
        if not duration:
            found += f": its rays cover {math.degrees(angle):g}°, and the scanner makes one turn in a period"
            help_ = "angles of at most 360°, or a <duration> in <sweep>"
        element.error("SK-SENSOR-201", found, help_)
        return None
    return options


def column_interval(options: SweepOptions, columns: int, angle: float, rate: float) -> float:
    """Return the time between two neighbouring columns [s].

    A scanner without a `<duration>` makes one turn in each period, as most drivers assume.
    """
    if columns < 2:
        return 0.0
    duration = options.duration or abs(angle) / _TURN / rate
    return duration / (columns - 1)


def last_time(options: SweepOptions, columns: int, angle: float, rate: float) -> float:
    """Return the time from the first ray to the last [s]."""
    return column_interval(options, columns, angle, rate) * (columns - 1) + max(options.firing_offsets, default=0.0)


def make_pattern(options: SweepOptions, directions: Vector, columns: int, angle: float, rate: float) -> RayPattern:
    """Return the pattern of a scan at a rate [Hz]."""
    times = column_interval(options, columns, angle, rate) * np.arange(float(columns))
    if options.is_clockwise:
        times = times[::-1]
    if options.firing_offsets:
        times = (np.array(options.firing_offsets)[:, None] + times).ravel()
    return RayPattern(directions, np.ascontiguousarray(times))
