"""Laser distance sensors of ROBOTIS, those of the TurtleBot3."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep
from simkit.sensors.presets.preset import Preset

_FROM_THE_FRONT = sweep(360, 0.0, 359.0)  # as their ROS driver counts: the first ray points forward

PRESETS = (
    Preset(
        "LDS-01",
        "lidar",
        "ROBOTIS",
        "ROBOTIS e-Manual, TurtleBot3, LDS-01: measurement performance specifications",
        lidar(_FROM_THE_FRONT, 0.12, 3.5, 0.01),
        rate=5.0,
        aliases=("HLS-LFCD2",),
        remark="deviation: our choice, the precision of ±10 mm up to 0.5 m; beyond, it is ±3.5 %; accuracy left out",
    ),
    Preset(
        "LDS-02",
        "lidar",
        "ROBOTIS",
        "ROBOTIS e-Manual, TurtleBot3, LDS-02: measurement performance specifications",
        lidar(_FROM_THE_FRONT, 0.16, 8.0, 0.01),
        rate=5.0,
        aliases=("LD08",),
        remark="deviation: our choice, the accuracy of ±10 mm up to 0.3 m; beyond, it is ±3 %, from 6 m on ±5 %",
    ),
)
