"""Magnetometers, and a barometer that keeps them company on autopilots; typical values."""

from __future__ import annotations

from simkit.sensors.presets.blocks import GAUSS, axes, gaussian
from simkit.sensors.presets.preset import Preset

PRESETS = (
    Preset(
        "HMC5883L",
        "magnetometer",
        "Honeywell",
        "HMC5883L data sheet, specifications: field resolution (deviation of 100 samples) 2 mG, default rate",
        {"magnetometer": axes(gaussian(stddev=2e-3 * GAUSS))},
        rate=15.0,
    ),
    Preset(
        "LIS3MDL",
        "magnetometer",
        "STMicroelectronics",
        "LIS3MDL data sheet DocID024204 rev. 4, 2.1: RMS noise at ±12 G, ultra-high-performance mode",
        {"magnetometer": axes(gaussian(stddev=3.2e-3 * GAUSS), z=gaussian(stddev=4.1e-3 * GAUSS))},
    ),
    Preset(
        "RM3100",
        "magnetometer",
        "PNI",
        "PNI RM3100 user manual; PNI on magneto-inductive technology: typically 15 nT RMS at 200 cycle counts",
        {"magnetometer": axes(gaussian(stddev=15e-9))},
    ),
    Preset(
        "MS5611",
        "air_pressure",
        "TE Connectivity",
        "MS5611-01BA03 data sheet, technical data: resolution 0.012 mbar at oversampling 4096",
        {"air_pressure": {"pressure": gaussian(stddev=1.2)}},
    ),
)
