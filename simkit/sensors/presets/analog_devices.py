"""Calibrated inertial measurement units of Analog Devices; typical values."""

from __future__ import annotations

from simkit.sensors.presets.blocks import inertial
from simkit.sensors.presets.preset import Preset

PRESETS = (
    Preset(
        "ADIS16448",
        "imu",
        "Analog Devices",
        "ADIS16448 data sheet, specifications: rate and acceleration noise density, in-run bias stability",
        inertial(gyro=0.0135, accelerometer=230, gyro_floor=14.5, accelerometer_floor=250),
        rate=819.2,
        unconfirmed=("bias_instability",),
    ),
    Preset(
        "ADIS16470",
        "imu",
        "Analog Devices",
        "ADIS16470 data sheet rev. C, features and specifications: noise densities, in-run bias stability",
        inertial(gyro=0.008, accelerometer=100, gyro_floor=8, accelerometer_floor=13),
        rate=2000.0,
        unconfirmed=("linear_acceleration noise_density",),
    ),
)
