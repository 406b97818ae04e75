"""Satellite receivers of u-blox, at the rate they come with."""

from __future__ import annotations

from simkit.sensors.presets.blocks import CIRCULAR_50, LINEAR_50, gaussian
from simkit.sensors.presets.preset import Preset, Settings

_WHITE = "deviations are of normal numbers of which half are within what is published; a real error changes slowly"


def _navsat(horizontal: float, vertical: float = 0.0) -> Settings:
    """Of what holds half of the readings: its radius [m], and its height [m] where that is published."""
    position: dict[str, Settings] = {"horizontal": gaussian(stddev=horizontal / CIRCULAR_50)}
    if vertical:
        position["vertical"] = gaussian(stddev=vertical / LINEAR_50)
    velocity = {"horizontal": gaussian(stddev=0.05 / CIRCULAR_50)}
    return {"navsat": {"position_sensing": position, "velocity_sensing": velocity}}


PRESETS = (
    Preset(
        "NEO-M8N",
        "navsat",
        "u-blox",
        "NEO-M8 data sheet: autonomous horizontal position accuracy 2.5 m CEP, velocity 0.05 m/s (50 %)",
        _navsat(2.5),
        rate=1.0,
        remark=_WHITE + "; no noise of the height: no number of it is taken",
    ),
    Preset(
        "ZED-F9P",
        "navsat",
        "u-blox",
        "ZED-F9P data sheet: PVT horizontal position accuracy 1.5 m CEP, velocity 0.05 m/s (50 %)",
        _navsat(1.5),
        rate=1.0,
        remark=_WHITE + "; no noise of the height: no number of it is taken",
        unconfirmed=("position_sensing",),
    ),
    Preset(
        "ZED-F9P RTK",
        "navsat",
        "u-blox",
        "ZED-F9P data sheet: RTK horizontal position 0.01 m + 1 ppm CEP, height 0.01 m + 1 ppm R50",
        _navsat(0.01, 0.01),
        rate=1.0,
        remark=_WHITE + "; near the base station, with fixed ambiguities",
        unconfirmed=("position_sensing vertical",),
    ),
)
