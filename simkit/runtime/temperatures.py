"""Temperatures of what is drawn, for thermal cameras."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from simkit.runtime.worn import Worn


@dataclass(frozen=True, slots=True)
class HeatSignature:
    """A picture that a surface wears by its texture coordinates; its red tells the temperature.

    Attributes:
        coldest, hottest: where red is 0 and where it is full [K].
    """

    picture: Path
    coldest: float
    hottest: float


Temperature = float | HeatSignature


class Temperatures(Worn[Temperature]):
    """Temperature [K] or heat signature by scoped name of a model, a link or a visual; may be changed at any time.

        sim.temperatures["stove::base::plate"] = 450.0     # one visual
        sim.temperatures["stove"] = 310.0                  # all that has none of its own

    A visual has its own, else that of its link, else that of the innermost model around it that has one. A model that
    is removed takes them along; snapshots and reset bring back what was.
    """

    wearers = ("model", "link")
    read_by = "reads_temperatures"

    def checked(self, value: Temperature) -> Temperature:
        if isinstance(value, HeatSignature):
            return value
        kelvins = float(value)
        if not (math.isfinite(kelvins) and kelvins >= 0):
            raise ValueError(f"a temperature is a number of at least 0 [K], got {kelvins}")
        return kelvins
