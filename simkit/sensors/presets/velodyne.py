"""Lidars of Velodyne with evenly spaced beams; HDL-64E and VLP-32C have not, and are left out."""

from __future__ import annotations

from simkit.sensors.presets.blocks import lidar, sweep, turn
from simkit.sensors.presets.preset import Preset

_LEAST = "; least range: that of the ROS 1 launch files of velodyne_pointcloud"

PRESETS = (
    Preset(
        "VLP-16",
        "lidar",
        "Velodyne",
        "Velodyne Puck data sheet 63-9229; VLP-16 user manual 63-9243 Rev. D, 8.3.1 and 9.2: angles",
        lidar(turn(1800), 0.4, 100.0, 0.03, sweep(16, -15.0, 15.0)),
        rate=10.0,
        aliases=("Puck", "VLP16"),
        remark="deviation: our choice, the typical accuracy of ±3 cm" + _LEAST,
    ),
    Preset(
        "HDL-32E",
        "lidar",
        "Velodyne",
        "Velodyne HDL-32E data sheet; user's manual 63-9113: angles, a firing every 46.08 µs",
        lidar(turn(2170), 0.4, 100.0, 0.02, sweep(32, -30.67, 10.67)),
        rate=10.0,
        remark="deviation: our choice, the typical accuracy of ±2 cm; samples: those of 10 Hz"
        + _LEAST
        + " (the manual has returns from 5 cm on)",
        unconfirmed=("stddev",),
    ),
)
