"""Options of a lidar's block in a file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from simkit.params import Params
from simkit.pose import Vector
from simkit.sensors.noise import NoiseModel, read_noise
from simkit.sensors.visibility_mask import ALL_VISIBLE, read_visibility_mask

_MAX_RAYS = 4_000_000
MAX_RANGE = 3e38  # [m]; a message's numbers have 32 bits
_MAX_ANGLE = 1e6  # [rad]; beyond it the rays of a scan are no longer told apart


@dataclass(frozen=True, slots=True)
class Sweep:
    """`samples` angles from `low` to `high` [rad], both included."""

    samples: int
    low: float
    high: float

    @property
    def step(self) -> float:
        return (self.high - self.low) / (self.samples - 1) if self.samples > 1 else 0.0

    @property
    def angles(self) -> Vector:
        """[rad], shape (samples,)."""
        angles: Vector = self.low + self.step * np.arange(float(self.samples))
        return angles


@dataclass(frozen=True, slots=True)
class LidarOptions:
    """The `<lidar>` or `<ray>` block; ranges in m.

    Attributes:
        visibility_mask: visuals are seen that have one of its bits among their `<visibility_flags>`.
    """

    horizontal: Sweep
    vertical: Sweep
    range_min: float
    range_max: float
    noise: NoiseModel
    visibility_mask: int = ALL_VISIBLE


def read_options(params: Params) -> LidarOptions:
    block = params.child("lidar") or params.block("ray")
    scan, limits = block.block("scan"), block.block("range")
    limits.child("resolution")
    block.child("visualize")
    low = limits.number("min", 0.0, minimum=0)
    high = limits.number("max", 0.0, minimum=0, finite=False)
    if MAX_RANGE < high < np.inf:
        limits.block("max").error("SK-PARAM-002", f"found {high:g} m, allowed is at most {MAX_RANGE:g}, or inf")
        low, high = 0.0, 1.0
    if not high > low:
        limits.error("SK-PARAM-002", f"found a range from {low:g} to {high:g} m, allowed is a <max> above <min>")
    horizontal = _read_sweep(scan.block("horizontal"), 640)
    vertical = _read_sweep(scan.block("vertical"), 1)
    if horizontal.samples * vertical.samples > _MAX_RAYS:
        rays = horizontal.samples * vertical.samples
        scan.error("SK-PARAM-002", f"found {rays} rays, allowed are at most {_MAX_RAYS}")
        horizontal = vertical = Sweep(1, 0.0, 0.0)
    return LidarOptions(horizontal, vertical, low, high, read_noise(block, "gaussian"), read_visibility_mask(block))


def _read_sweep(params: Params, samples: int) -> Sweep:
    resolution = params.number("resolution", 1.0, minimum=0)
    count = params.integer("samples", samples, minimum=1)
    if count > 1 and resolution not in (0.0, 1.0):
        message = f"<resolution>{resolution:g}</resolution>: one ray per sample is cast, as Gazebo does"
        params.diagnostics.note("SK-SENSOR-003", message, params.where)
    low = params.number("min_angle", 0.0, minimum=-_MAX_ANGLE, maximum=_MAX_ANGLE)
    high = params.number("max_angle", 0.0, minimum=-_MAX_ANGLE, maximum=_MAX_ANGLE)
    if high < low:
        params.error(
            "SK-PARAM-002", f"found angles from {low:g} to {high:g}, allowed is a <max_angle> of at least <min_angle>"
        )
    return Sweep(count, low, high)
