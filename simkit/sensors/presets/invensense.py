"""Motion sensors of TDK InvenSense; typical values."""

from __future__ import annotations

from simkit.sensors.presets.blocks import axes, inertial, quantized
from simkit.sensors.presets.preset import Preset

_COUNT = 0.15e-6  # T, of the AK09916 and, at 16 bit, of the AK8963 in them

PRESETS = (
    Preset(
        "MPU-6050",
        "imu",
        "TDK InvenSense",
        "MPU-6000/MPU-6050 product specification PS-MPU-6000A-00 rev. 3.4, 6.1 and 6.2: noise spectral densities",
        inertial(gyro=0.005, accelerometer=400),
        aliases=("MPU-6000",),
    ),
    Preset(
        "MPU-9250",
        "imu",
        "TDK InvenSense",
        "MPU-9250 product specification PS-MPU-9250A-01 rev. 1.1, 3.1 and 3.2: noise spectral densities",
        inertial(gyro=0.01, accelerometer=300),
    ),
    Preset(
        "MPU-9250",
        "magnetometer",
        "TDK InvenSense",
        "MPU-9250 product specification PS-MPU-9250A-01 rev. 1.1, 3.3: sensitivity at 16 bit",
        {"magnetometer": axes(quantized(precision=_COUNT))},
        aliases=("AK8963",),
        remark="only its counts: no noise is published",
    ),
    Preset(
        "ICM-20948",
        "imu",
        "TDK InvenSense",
        "ICM-20948 data sheet DS-000189 rev. 1.3, 3.1 and 3.2: noise spectral densities",
        inertial(gyro=0.015, accelerometer=230),
    ),
    Preset(
        "ICM-20948",
        "magnetometer",
        "TDK InvenSense",
        "ICM-20948 data sheet DS-000189 rev. 1.3, 3.3: sensitivity, output data rate",
        {"magnetometer": axes(quantized(precision=_COUNT))},
        rate=100.0,
        aliases=("AK09916",),
        remark="only its counts: no noise is published",
    ),
)
