"""Lidars of Velodyne with evenly spaced beams; HDL-64E and VLP-32C have not, and are left out."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep, turn
from simkit.sensors.presets.preset import Preset

_LEAST = "; least range: that of ROS's driver velodyne_pointcloud"

PRESETS = (
    Preset(
        "VLP-16",
        "lidar",
        "Velodyne",
        "Velodyne Puck data sheet 63-9229, sensor; VLP-16 user manual 63-9243 Rev. D, 8.3",
        lidar(turn(1800), 0.4, 100.0, 0.03, sweep(16, -15.0, 15.0)),
        rate=10.0,
        aliases=("Puck", "VLP16"),
        remark="deviation: the typical accuracy of ±3 cm" + _LEAST,
    ),
    Preset(
        "HDL-32E",
        "lidar",
        "Velodyne",
        "Velodyne HDL-32E data sheet 97-0038, sensor; user manual 63-9113: a firing every 46.08 µs",
        lidar(turn(2170), 0.9, 100.0, 0.02, sweep(32, -30.67, 10.67)),
        rate=10.0,
        remark="deviation: the typical accuracy of ±2 cm; the samples are those between two firings at 10 Hz" + _LEAST,
    ),
)
