"""Wind of PX4's worlds for Gazebo Classic: `libgazebo_wind_plugin.so`.

Parameters, defaults and formulas are those of `gazebo_wind_plugin.cpp` of PX4-SITL_gazebo-classic.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from simkit import Params, WorldPlugin
from simkit.extend import LARGEST, Options, OptionsOf, number, vector3, without_effect
from simkit_water_and_air.plugins.fluids.tuple_vectors import Triple, unit

if TYPE_CHECKING:
    from simkit import Simulation


class Px4WindOptions(Options):
    """Options of `Px4Wind`."""

    namespace: bool = without_effect(element="robotNamespace")
    frame: bool = without_effect(element="frameId")
    topic: bool = without_effect(element="windPubTopic")
    rate: float = number(2.0, "Hz", element="publishRate", minimum=0.0, maximum=LARGEST)
    mean: float = number(0.0, "m/s", element="windVelocityMean")
    most: float = number(100.0, "m/s", element="windVelocityMax", minimum=0.0)
    variance: float = number(0.0, "m²/s²", element="windVelocityVariance", minimum=0.0)
    direction: tuple[float, float, float] = vector3((1.0, 0.0, 0.0), element="windDirectionMean")
    turning: float = number(0.0, element="windDirectionVariance", minimum=0.0)
    gust_start: float = number(10.0, "s", element="windGustStart")
    gust_duration: float = number(0.0, "s", element="windGustDuration", minimum=0.0)
    gust_mean: float = number(0.0, "m/s", element="windGustVelocityMean")
    gust_most: float = number(10.0, "m/s", element="windGustVelocityMax", minimum=0.0)
    gust_variance: float = number(0.0, "m²/s²", element="windGustVelocityVariance", minimum=0.0)
    gust_direction: tuple[float, float, float] = vector3((0.0, 1.0, 0.0), element="windGustDirectionMean")
    gust_turning: float = number(0.0, element="windGustDirectionVariance", minimum=0.0)
    ramp_start: float = number(0.0, "s", element="windRampStart")
    ramp_duration: float = number(0.0, "s", element="windChangeRampDuration", minimum=0.0)
    ramp: tuple[float, float, float] = vector3(unit="m/s", element="windRampWindVectorComponents")


class Px4Wind(WorldPlugin):
    """Sets the wind of the world [m/s], `<publishRate>` times a second: mean wind, one gust and a ramp.

    Strength and direction are normally distributed around `<windVelocityMean>` and `<windDirectionMean>`, and those of
    the gust likewise; the strength is at most `<windVelocityMax>`.
    """

    options = OptionsOf(Px4WindOptions)
    filenames = ("libgazebo_wind_plugin.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        self.options.read_all()
        self._stream = self.random("wind", 8)
        if parent.engine.wind.source is None:
            parent.engine.wind.source = self.velocity

    def velocity(self, tick: int) -> Triple:
        """Return the velocity of the air [m/s] in the world frame, during the step after a tick."""
        o, time = self.options, tick * self.sim.timestep
        index = math.floor(time * o.rate + 1e-9)
        if index <= 0:  # the first wind comes after the first period
            return 0.0, 0.0, 0.0
        drawn, time = self._stream.normal(index).tolist(), index / o.rate
        wind = _blow(o.mean, o.most, o.variance, o.direction, o.turning, drawn[:4])
        share = min(max((time - o.ramp_start) / o.ramp_duration, 0.0), 1.0) if o.ramp_duration > 0 else 0.0
        gust = (0.0, 0.0, 0.0)
        if o.gust_start <= time < o.gust_start + o.gust_duration:
            gust = _blow(o.gust_mean, o.gust_most, o.gust_variance, o.gust_direction, o.gust_turning, drawn[4:])
        x, y, z = (w + g + share * r for w, g, r in zip(wind, gust, o.ramp, strict=True))
        return x, y, z


def _blow(mean: float, most: float, variance: float, direction: Triple, turning: float, drawn: list[float]) -> Triple:
    """Return a wind of random strength and direction [m/s], from four normal numbers."""
    strength = min(abs(mean + math.sqrt(variance) * drawn[0]), most)
    x, y, z = unit(direction) if any(direction) else direction
    spread = math.sqrt(turning)
    return strength * (x + spread * drawn[1]), strength * (y + spread * drawn[2]), strength * (z + spread * drawn[3])
