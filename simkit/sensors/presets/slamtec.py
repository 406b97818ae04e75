"""RPLIDAR planar laser scanners of SLAMTEC."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, turn
from simkit.sensors.presets.preset import Preset

_TRIANGULATION = "no noise: the data sheet gives parts of the range, which is no one deviation"

PRESETS = (
    Preset(
        "RPLIDAR A1",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A1 data sheet (2016), measurement performance (A1M8, typical scan rate)",
        lidar(turn(360), 0.15, 12.0),
        rate=5.5,
        aliases=("A1M8", "RPLIDAR A1M8"),
        remark=_TRIANGULATION + "; 360 samples a scan at 5.5 Hz; newer revisions have more, of up to 8000 a second",
    ),
    Preset(
        "RPLIDAR A2",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A2 data sheet rev. 2.5 (2019), measurement performance (A2M8, typical scan rate)",
        lidar(turn(800), 0.15, 12.0),
        rate=10.0,
        aliases=("A2M8", "RPLIDAR A2M8"),
        remark=_TRIANGULATION + "; the samples are 8000 a second at 10 Hz",
    ),
    Preset(
        "RPLIDAR A3",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR A3 data sheet, measurement performance (A3M1, enhanced mode, white object)",
        lidar(turn(1600), 0.2, 25.0),
        rate=10.0,
        aliases=("A3M1", "RPLIDAR A3M1"),
        remark=_TRIANGULATION + "; the samples are 16 000 a second at 10 Hz",
    ),
    Preset(
        "RPLIDAR S1",
        "lidar",
        "SLAMTEC",
        "SLAMTEC RPLIDAR S1 data sheet, measurement performance (S1M1, white object)",
        lidar(turn(920), 0.1, 40.0, 0.05),
        rate=10.0,
        aliases=("S1M1", "RPLIDAR S1M1"),
        remark="deviation: our choice, the accuracy of ±5 cm; the samples are 9200 a second at 10 Hz",
        unconfirmed=("min", "stddev"),
    ),
)
