"""Lidars of Ouster with evenly spaced beams: sensors of revision 06, not of 7, which reach farther."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep, turn
from simkit.sensors.presets.preset import Preset

_REMARK = (
    "range: of 80 % reflectivity, found with more than 90 % probability; the angles are the nominal field of view; "
    "no noise: the precision changes with range and target, and the accuracy of ±3 cm is left out"
)


def _revision_06(family: str, beams: int, half_view: float, farthest: float) -> Preset:
    """One of them; half of its vertical view [°] and its range [m]."""
    return Preset(
        f"{family}-{beams}",
        "lidar",
        "Ouster",
        f"Ouster {family} data sheet, Rev 06 sensors, optical performance, mode 1024x10",
        lidar(turn(1024), 0.3, farthest, 0.0, sweep(beams, -half_view, half_view)),
        rate=10.0,
        remark=_REMARK,
    )


PRESETS = (
    *(_revision_06("OS0", beams, 45.0, 45.0) for beams in (32, 64, 128)),
    *(_revision_06("OS1", beams, 22.5, 100.0) for beams in (32, 64, 128)),
)
