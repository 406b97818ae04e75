"""Temperature, pressure and density of the air at a height: the U.S. Standard Atmosphere of 1976, or a world's own.

The air is an ideal gas at rest. Its temperature changes linearly with the geopotential height within a layer. A world's
`<atmosphere>` gives temperature and pressure at sea level and the rate of the lowest layer. The rates of all higher
layers are from the standard. Above the standard's last layer, the temperature is constant.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from functools import lru_cache
from typing import Final, NamedTuple

from simkit.scene import Atmosphere

GRAVITY: Final = 9.80665
"""Standard gravity [m/s²], which defines geopotential heights."""

GAS_CONSTANT: Final = 8314.32
"""Gas constant of the standard of 1976 [J/(kmol·K)]."""

MOLAR_MASS: Final = 28.9644
"""Molar mass of air [kg/kmol]."""

EARTH_RADIUS: Final = 6356766.0
"""Radius of the Earth for geopotential heights [m]."""

MIN_ALTITUDE, MAX_ALTITUDE = -5000.0, 86000.0
"""Heights that the standard's table covers [m]; beyond them the table is extrapolated."""

_LAPSE_RATES: Final = ((11e3, 0.0), (20e3, 0.001), (32e3, 0.0028), (47e3, 0.0), (51e3, -0.0028), (71e3, -0.002))
_TOP: Final = 84852.0  # geopotential height of 86 km [m]
_MIN_TEMPERATURE: Final = 1.0  # [K] lower bound, so that an absurd rate gives a vacuum and not NaN
_MAX_EXPONENT: Final = 400.0  # largest logarithm of a pressure ratio
_HYDROSTATIC: Final = GRAVITY * MOLAR_MASS / GAS_CONSTANT  # [K/m]


class Layer(NamedTuple):
    """Layer of air that begins at a geopotential height [m], with temperature [K], pressure [Pa] and rate [K/m]."""

    base: float
    temperature: float
    pressure: float
    rate: float

    def at(self, height: float) -> tuple[float, float]:
        """Return the temperature [K] and pressure [Pa] at a geopotential height [m]."""
        rise = height - self.base
        temperature = self.temperature + self.rate * rise
        if self.rate:
            ratio = -_HYDROSTATIC / self.rate * math.log1p(self.rate * rise / self.temperature)
        else:
            ratio = -_HYDROSTATIC * rise / self.temperature
        return temperature, self.pressure * math.exp(max(-_MAX_EXPONENT, min(ratio, _MAX_EXPONENT)))


class AirState(NamedTuple):
    """Temperature [K], pressure [Pa] and density [kg/m³] of the air."""

    temperature: float
    pressure: float
    density: float


class AirColumn:
    """Column of air above and below sea level.

    Args:
        temperature: temperature at sea level [K].
        gradient: change of the temperature with height at sea level [K/m].
        pressure: pressure at sea level [Pa].
    """

    def __init__(self, temperature: float, gradient: float, pressure: float) -> None:
        lowest = Layer(0.0, max(temperature, _MIN_TEMPERATURE), pressure, gradient)
        layers, bounds = [lowest], []
        if gradient > 0:  # the temperature falls with depth
            end = (_MIN_TEMPERATURE - lowest.temperature) / gradient
            layers.insert(0, Layer(end, *lowest.at(end), 0.0))
            bounds.append(end)
        for base, rate in (*_LAPSE_RATES, (_TOP, 0.0)):
            last = layers[-1]
            end = last.base + (_MIN_TEMPERATURE - last.temperature) / last.rate if last.rate < 0 else math.inf
            if end < base:
                base, rate = end, 0.0
            layers.append(Layer(base, *last.at(base), rate))
            bounds.append(base)
            if base == end:
                break
        self._layers, self._bounds = layers, bounds

    def at(self, height: float) -> AirState:
        """Return the air at a geometric height above sea level [m]; finite and never negative at any height."""
        # below half the Earth's radius the model is meaningless, and the formula would divide by zero
        height = max(height, -0.5 * EARTH_RADIUS)
        geopotential = EARTH_RADIUS * (height / (EARTH_RADIUS + height))
        layer = self._layers[bisect_right(self._bounds, geopotential)]
        temperature, pressure = layer.at(geopotential)
        return AirState(temperature, pressure, pressure * MOLAR_MASS / (GAS_CONSTANT * temperature))


@lru_cache(maxsize=16)
def air_column(atmosphere: Atmosphere) -> AirColumn:
    """Return the air column of a world."""
    return AirColumn(atmosphere.temperature, atmosphere.temperature_gradient, atmosphere.pressure)
