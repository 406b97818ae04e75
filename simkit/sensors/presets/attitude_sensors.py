"""Attitude and heading reference systems: calibrated inertial sensors and a magnetometer in one housing."""

from __future__ import annotations

from simkit.sensors.presets.blocks import GAUSS, axes, gaussian, inertial
from simkit.sensors.presets.preset import Preset

_VN_100 = "VectorNav VN-100 data sheet, sensor specifications"
_MTI_1 = "Xsens MTi 1-series data sheet, sensor specifications"
_MTI_300 = "Xsens MTi 100-series leaflet, sensor specifications"

PRESETS = (
    Preset(
        "VN-100",
        "imu",
        "VectorNav",
        _VN_100 + ": noise densities, bounds of the in-run bias stability",
        inertial(gyro=0.0035, accelerometer=140, gyro_floor=10, accelerometer_floor=40),
        rate=800.0,
    ),
    Preset(
        "VN-100",
        "magnetometer",
        "VectorNav",
        _VN_100 + ": noise density",
        {"magnetometer": axes(gaussian(noise_density=140e-6 * GAUSS))},
    ),
    Preset(
        "MTi-1",
        "imu",
        "Xsens",
        _MTI_1 + ": noise densities, in-run bias stability",
        inertial(gyro=0.007, accelerometer=120, gyro_floor=10, accelerometer_floor=30),
        rate=100.0,
    ),
    Preset(
        "MTi-300",
        "imu",
        "Xsens",
        _MTI_300 + ": noise densities, in-run bias stability",
        inertial(gyro=0.01, accelerometer=60, gyro_floor=10, accelerometer_floor=15),
        rate=400.0,
        unconfirmed=("noise_density", "bias_instability"),
    ),
    Preset(
        "MTi-300",
        "magnetometer",
        "Xsens",
        _MTI_300 + ": total RMS noise",
        {"magnetometer": axes(gaussian(stddev=0.5e-3 * GAUSS))},
        unconfirmed=("stddev",),
    ),
    Preset(
        "MTi-300",
        "air_pressure",
        "Xsens",
        _MTI_300 + ": total RMS noise",
        {"air_pressure": {"pressure": gaussian(stddev=3.6)}},
        unconfirmed=("stddev",),
    ),
)
