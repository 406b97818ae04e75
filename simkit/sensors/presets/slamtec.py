"""RPLIDAR planar laser scanners of SLAMTEC."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, turn
from simkit.sensors.presets.preset import Preset

_TRIANGULATION = "no noise: the data sheet gives a resolution of 1 % of the range, which is no one deviation"

PRESETS = (
    Preset(
        "RPLIDAR A1",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A1 data sheet LD108, measurement performance (A1M8, typical scan rate)",
        lidar(turn(360), 0.15, 12.0),
        rate=5.5,
        aliases=("A1M8", "RPLIDAR A1M8"),
        remark=_TRIANGULATION + "; the samples are those of an angular resolution of 1°",
    ),
    Preset(
        "RPLIDAR A2",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A2 data sheet LD208, measurement performance (A2M8, typical scan rate)",
        lidar(turn(800), 0.15, 12.0),
        rate=10.0,
        aliases=("A2M8", "RPLIDAR A2M8"),
        remark=_TRIANGULATION + "; the samples are 8000 a second at 10 Hz",
    ),
    Preset(
        "RPLIDAR A3",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A3 data sheet LD310, measurement performance (A3M1, enhanced mode, white object)",
        lidar(turn(1600), 0.2, 25.0),
        rate=10.0,
        aliases=("A3M1", "RPLIDAR A3M1"),
        remark=_TRIANGULATION + "; the samples are 16 000 a second at 10 Hz",
    ),
    Preset(
        "RPLIDAR S1",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR S1 data sheet LD601, measurement performance (S1M1, white object)",
        lidar(turn(920), 0.1, 40.0, 0.05),
        rate=10.0,
        aliases=("S1M1", "RPLIDAR S1M1"),
        remark="deviation: the accuracy of ±5 cm; the samples are 9200 a second at 10 Hz",
    ),
)
