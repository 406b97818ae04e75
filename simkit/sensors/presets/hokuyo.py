"""Planar laser scanners of Hokuyo."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep
from simkit.sensors.presets.preset import Preset

# 1024 steps a turn; those from 44 to 725 are measured, 384 is the front (SCIP 2.0 specification C-42-03320B, table 2)
_STEP = 360.0 / 1024.0
_URG = sweep(682, (44 - 384) * _STEP, (725 - 384) * _STEP)

PRESETS = (
    Preset(
        "URG-04LX",
        "lidar",
        "Hokuyo",
        "Hokuyo URG-04LX specifications; SCIP 2.0 specification C-42-03320B: steps",
        lidar(_URG, 0.06, 4.095, 0.01),
        rate=10.0,
        remark="deviation: our choice, the accuracy of ±10 mm up to 1 m; beyond, it is ±1 %",
        unconfirmed=("min", "max", "stddev"),
    ),
    Preset(
        "URG-04LX-UG01",
        "lidar",
        "Hokuyo",
        "Hokuyo URG-04LX-UG01 specifications; SCIP 2.0 specification C-42-03320B: steps",
        lidar(_URG, 0.02, 5.6, 0.03),
        rate=10.0,
        remark="deviation: our choice, the accuracy of ±30 mm up to 1 m; beyond, it is ±3 %, from 4.095 m on not given",
    ),
    Preset(
        "UTM-30LX",
        "lidar",
        "Hokuyo",
        "Hokuyo UTM-30LX specification: detection range, repeated accuracy σ < 10 mm up to 10 m",
        lidar(sweep(1081, -135.0, 135.0), 0.1, 30.0, 0.01),
        rate=40.0,
        aliases=("UTM-30LX-EW",),
        remark="deviation: our choice, that bound; beyond 10 m it is 30 mm; the accuracy of ±30 mm is left out",
    ),
)
