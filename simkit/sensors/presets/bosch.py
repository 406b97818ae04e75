"""Inertial sensors and barometers of Bosch Sensortec; typical values."""

from __future__ import annotations

from simkit.sensors.presets.blocks import DEGREE, MICRO_G, axes, gaussian, imu, inertial
from simkit.sensors.presets.preset import Preset

PRESETS = (
    Preset(
        "BMI088",
        "imu",
        "Bosch Sensortec",
        "BMI088 data sheet BST-BMI088-DS001-14 rev. 1.4, specification: noise densities (accelerometer at 3 g)",
        imu(
            axes(gaussian(noise_density=0.014 * DEGREE)),
            axes(gaussian(noise_density=160 * MICRO_G), z=gaussian(noise_density=190 * MICRO_G)),
        ),
    ),
    Preset(
        "BMI160",
        "imu",
        "Bosch Sensortec",
        "BMI160 data sheet BST-BMI160-DS000, electrical specification: output noise densities",
        inertial(gyro=0.007, accelerometer=180),
    ),
    Preset(
        "BNO055",
        "imu",
        "Bosch Sensortec",
        "BNO055 data sheet BST-BNO055-DS000, specification: noise densities; 100 Hz is its rate in fusion modes",
        inertial(gyro=0.014, accelerometer=150),
        rate=100.0,
        remark="the error of its own attitude filter is left out",
    ),
    Preset(
        "BMP280",
        "air_pressure",
        "Bosch Sensortec",
        "BMP280 data sheet BST-BMP280-DS001, 3.5: RMS noise at ultra high resolution, full bandwidth",
        {"air_pressure": {"pressure": gaussian(stddev=1.3)}},
        unconfirmed=("stddev",),
    ),
    Preset(
        "BMP388",
        "air_pressure",
        "Bosch Sensortec",
        "BMP388 data sheet BST-BMP388-DS001, specification: RMS noise at highest resolution, lowest bandwidth",
        {"air_pressure": {"pressure": gaussian(stddev=0.03)}},
        unconfirmed=("stddev",),
    ),
)
