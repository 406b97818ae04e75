"""Blocks of SDF elements that data sheets of one kind have in common, and their units in SI."""

from __future__ import annotations

import math
from typing import Any

from simkit.sensors.bias_drift import ALLAN_FLOOR
from simkit.sensors.presets.preset import Settings

DEGREE = math.pi / 180.0  # rad
DEGREE_PER_HOUR = DEGREE / 3600.0  # rad/s
GRAVITY = 9.80665  # m/s²
MICRO_G = 1e-6 * GRAVITY  # m/s²
GAUSS = 1e-4  # T
CIRCULAR_50 = math.sqrt(2.0 * math.log(2.0))
"""Radius that holds half of the readings of two normal numbers of deviation 1: 1.177."""
LINEAR_50 = 0.6744898
"""The same of one normal number, either side."""


def gaussian(**parameters: float) -> Settings:
    """A `<noise>` of type gaussian."""
    return {"noise": {"@type": "gaussian", **_rounded(parameters)}}


def quantized(**parameters: float) -> Settings:
    """A `<noise>` that is rounded to `precision`."""
    return {"noise": {"@type": "gaussian_quantized", **_rounded(parameters)}}


def axes(x: Settings, y: Settings | None = None, z: Settings | None = None) -> Settings:
    """Noise of three axes; those not given are as x."""
    return {"x": x, "y": y or x, "z": z or x}


def sweep(samples: int, low: float, high: float) -> Settings:
    """Angles of a lidar, low and high in degrees, both included."""
    return {"samples": samples, "min_angle": round(low * DEGREE, 7), "max_angle": round(high * DEGREE, 7)}


def turn(samples: int) -> Settings:
    """Angles all around, from behind over the right, in front and left, none of them twice."""
    return sweep(samples, -180.0, 180.0 - 360.0 / samples)


def lidar(
    horizontal: Settings, low: float, high: float, stddev: float = 0.0, vertical: Settings | None = None
) -> Settings:
    """The `<lidar>` block: range from `low` to `high` and its standard deviation, in metres."""
    scan = {"horizontal": horizontal, **({"vertical": vertical} if vertical else {})}
    noise: dict[str, Any] = {"noise": {"type": "gaussian", "stddev": stddev}} if stddev else {}
    return {"lidar": {"scan": scan, "range": {"min": low, "max": high}, **noise}}


def imu(rate: Settings, force: Settings) -> Settings:
    """The `<imu>` block, of the noise of each axis of the rate and of the specific force."""
    return {"imu": {"angular_velocity": rate, "linear_acceleration": force}}


def inertial(gyro: float, accelerometer: float, gyro_floor: float = 0.0, accelerometer_floor: float = 0.0) -> Settings:
    """The `<imu>` block of a device with the same numbers on all axes.

    Args:
        gyro: noise density [°/s/√Hz].
        accelerometer: noise density [µg/√Hz].
        gyro_floor: in-run bias stability [°/h].
        accelerometer_floor: in-run bias stability [µg].
    """
    rate = {"noise_density": gyro * DEGREE}
    force = {"noise_density": accelerometer * MICRO_G}
    if gyro_floor:
        rate["bias_instability"] = gyro_floor * DEGREE_PER_HOUR / ALLAN_FLOOR
    if accelerometer_floor:
        force["bias_instability"] = accelerometer_floor * MICRO_G / ALLAN_FLOOR
    return imu(axes(gaussian(**rate)), axes(gaussian(**force)))


def _rounded(parameters: dict[str, float]) -> dict[str, float]:
    """To six digits, more than any data sheet has."""
    return {name: float(f"{value:.6g}") for name, value in parameters.items()}
