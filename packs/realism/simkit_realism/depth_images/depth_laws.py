"""Laws of positive numbers, such as the noise of a depth, looked up by the leading bits of a 32-bit float.

A look-up is faster than the elementary functions, and NumPy's own have other bits on other processors.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import log, power
from simkit.sensors.cameras.random_pixels import look_up

Depths = npt.NDArray[np.float32]
_SHIFT = 12  # a table has 2048 entries for each doubling: steps of 0.05 %
_NEAREST, _FARTHEST = 2.0**-10, 2.0**14  # range of the tables


def _leading_bits(depth: float) -> int:
    return int(np.float32(depth).view(np.uint32)) >> _SHIFT


class LawTable:
    """Table of a function of positive numbers, such as depths [m].

    Args:
        function: function of an array.
    """

    def __init__(self, function: Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]) -> None:
        self._first = _leading_bits(_NEAREST)
        bits = (np.arange(self._first, _leading_bits(_FARTHEST), dtype=np.uint32) << _SHIFT) + (1 << (_SHIFT - 1))
        values = function(bits.view(np.float32).astype(np.float64)).astype(np.float32)
        self._last = len(values) - 1
        self._table = np.concatenate((values, np.zeros(65536 - len(values), np.float32)))

    def of(self, numbers: Depths) -> Depths:
        """Return the value for each number; those outside 0.001 to 16000 have the value of the nearest one."""
        bits = numbers.view(np.int32) >> _SHIFT  # signed, so that negative numbers are below the table
        bits -= self._first
        np.clip(bits, 0, self._last, out=bits)
        values = np.empty(numbers.shape, np.float32)
        look_up(self._table, bits.astype(np.uint16), values)
        return values


def power_law(floor: float, coefficient: float, exponent: float, start: float) -> LawTable:
    """Return the law max(floor, coefficient·max(0, z - start)^exponent)."""

    def law(depths: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return np.maximum(floor, coefficient * power(np.maximum(depths - start, 0.0), exponent))

    return LawTable(law)


def law_of_points(points: Sequence[tuple[float, float]]) -> LawTable:
    """Return the law through measured points (depth, value), all positive, that is a power law between two points.

    Below the first and beyond the last point, the nearest power law continues, but never decreases with the depth
    there. A single point is a constant.
    """
    if len(points) == 1:
        return LawTable(lambda depths: np.full(depths.shape, points[0][1]))
    x = [math.log(depth) for depth, _ in points]
    y = [math.log(value) for _, value in points]
    slopes = [(y[i + 1] - y[i]) / (x[i + 1] - x[i]) for i in range(len(x) - 1)]
    inner = np.array([*slopes])

    def law(depths: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        logs = log(depths)
        part = np.clip(np.searchsorted(x, logs) - 1, 0, len(slopes) - 1)
        slope = inner[part]
        slope = np.where((logs < x[0]) | (logs > x[-1]), np.maximum(slope, 0.0), slope)
        # beyond the last point, the line begins at that point, so that a slope of 0 continues its value
        begin = np.where(logs > x[-1], len(x) - 1, part)
        return power(np.full(logs.shape, math.e), np.array(y)[begin] + slope * (logs - np.array(x)[begin]))

    return LawTable(law)
