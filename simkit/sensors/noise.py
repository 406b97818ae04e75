"""Gaussian noise of the file: white noise, a bias drawn once, a bias that wanders, quantisation.

Differs from Gazebo on purpose: the bias keeps the sign the file gives it, and a wandering bias uses the true time
between samples everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from simkit.params import Params
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.runtime.random import RandomStreams

LARGEST_DEVIATION = 1e100  # of any channel; beyond it the variance leaves the numbers
_TYPES = ("none", "gaussian", "gaussian_quantized")


@dataclass(frozen=True, slots=True)
class NoiseModel:
    """Noise of one channel, in the channel's unit.

    Attributes:
        mean, stddev: of the white noise.
        bias_mean, bias_stddev: of the bias, drawn once.
        dynamic_bias_stddev, dynamic_bias_correlation_time: of the wandering part of the bias; the time in s.
        precision: step of the quantisation, 0 for none.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0
    precision: float = 0.0

    @property
    def wanders(self) -> bool:
        return self.dynamic_bias_stddev > 0 and self.dynamic_bias_correlation_time > 0


NO_NOISE = NoiseModel()


def read_noise(owner: Params) -> NoiseModel:
    """The `<noise>` of a block; its type may be an attribute or an element."""
    params = owner.child("noise")
    if params is None:
        return NO_NOISE
    kind = params.attribute("type") or params.text("type", "none")
    if kind not in _TYPES:
        params.error("SK-PARAM-002", f"found noise of type {kind!r}, allowed is {', '.join(_TYPES)}")
    if kind == "none":
        params.mark_all_read()
        return NO_NOISE
    return NoiseModel(
        mean=params.number("mean", 0.0),
        stddev=params.number("stddev", 0.0, minimum=0, maximum=LARGEST_DEVIATION),
        bias_mean=params.number("bias_mean", 0.0),
        bias_stddev=params.number("bias_stddev", 0.0, minimum=0),
        dynamic_bias_stddev=params.number("dynamic_bias_stddev", 0.0, minimum=0),
        dynamic_bias_correlation_time=params.number("dynamic_bias_correlation_time", 0.0, minimum=0),
        precision=params.number("precision", 0.0, minimum=0),
    )


class Noise:
    """The noise of a group of channels.

    A sample's draw depends on its index; what has no deviation draws nothing.

    Args:
        models: one per channel.
        streams: the simulation's.
        scoped: the sensor's name.
        group: names the group's streams.
    """

    def __init__(self, models: Sequence[NoiseModel], streams: RandomStreams, scoped: str, group: str) -> None:
        def column(name: str) -> Vector:
            return np.array([getattr(m, name) for m in models], dtype=np.float64)

        self.width = len(models)
        self._mean, self._stddev = column("mean"), column("stddev")
        self._bias_mean, self._bias_stddev = column("bias_mean"), column("bias_stddev")
        self._precision = column("precision")
        self._is_quantised = bool(self._precision.any())
        self._wandering = np.array([m.wanders for m in models])
        self._walk_stddev = np.where(self._wandering, column("dynamic_bias_stddev"), 0.0)
        self._walk_time = np.where(self._wandering, column("dynamic_bias_correlation_time"), 1.0)
        self._white = streams.stream(scoped, group, self.width) if self._stddev.any() else None
        self._drawn_bias = streams.stream(scoped, group + "/bias", self.width) if self._bias_stddev.any() else None
        self._walk = streams.stream(scoped, group + "/walk", self.width) if self._wandering.any() else None
        self.restart()
        # what shows in no digit is left out
        self.is_silent = (
            self._white is None and self._walk is None and not (self._constant.any() or self._is_quantised)
        )

    def restart(self) -> None:
        """Draws the bias."""
        bias = self._bias_mean.copy()
        if self._drawn_bias is not None:
            bias += self._bias_stddev * self._drawn_bias.normal(0)
        self._bias = bias
        self._constant = bias + self._mean

    def evolve(self, index: int, dt: float) -> None:
        """Moves the wandering bias on by `dt` [s]: an Ornstein-Uhlenbeck step, exact for any `dt`."""
        if self._walk is None or dt <= 0:
            return
        decay = np.exp(-dt / self._walk_time)
        spread = self._walk_stddev * np.sqrt(-self._walk_time / 2 * np.expm1(-2 * dt / self._walk_time))
        moved = decay * self._bias + spread * self._walk.normal(index)
        self._bias = np.where(self._wandering, moved, self._bias)
        self._constant = self._bias + self._mean

    def apply(self, values: Vector, index: int) -> Vector:
        """The values, shape (width,), of sample `index` with noise; infinite ones stay."""
        out: Vector = values + self._constant
        if self._white is not None:
            out += self._stddev * self._white.normal(index)
        if self._is_quantised:
            out = quantise(out, self._precision)
        return out

    @property
    def wanders(self) -> bool:
        """Whether it has a memory from sample to sample."""
        return self._walk is not None

    @property
    def offset(self) -> float:
        """What the first channel has besides white noise."""
        return float(self._constant[0])

    def memory(self) -> Any:
        return self._bias.copy()

    def remember(self, memory: Any) -> None:
        self._bias = memory.copy()
        self._constant = self._bias + self._mean


class UniformNoise:
    """The same noise model on every one of many channels (a lidar's rays); one bias for all.

    Args:
        width: channels.
    """

    def __init__(self, model: NoiseModel, width: int, streams: RandomStreams, scoped: str, group: str) -> None:
        self.model = model
        self._shared = Noise([replace(model, stddev=0.0, precision=0.0)], streams, scoped, group + "/shared")
        self._white = streams.stream(scoped, group, width) if model.stddev > 0 else None
        self.is_silent = self._white is None and self._shared.is_silent and model.precision == 0

    @property
    def wanders(self) -> bool:
        """Whether it has a memory from sample to sample."""
        return self._shared.wanders

    def restart(self) -> None:
        self._shared.restart()

    def evolve(self, index: int, dt: float) -> None:
        self._shared.evolve(index, dt)

    def apply(self, values: Vector, index: int) -> Vector:
        """The values, shape (width,), with noise; infinite ones stay infinite."""
        offset = self._shared.offset
        if self._white is not None:
            out = self._white.normal(index) * self.model.stddev
            out += values
        else:
            out = values.copy()
        if offset:
            out += offset
        if self.model.precision > 0:
            out = quantise(out, np.array([self.model.precision]))
        return out

    def memory(self) -> Any:
        return self._shared.memory()

    def remember(self, memory: Any) -> None:
        self._shared.remember(memory)


def quantise(values: Vector, precision: Vector) -> Vector:
    """To multiples of `precision` (where it is not 0), halves away from zero."""
    step = np.where(precision > 0, precision, 1.0)
    with np.errstate(invalid="ignore"):
        rounded = np.copysign(np.floor(np.abs(values) / step + 0.5) * step, values)
    out: Vector = np.where((precision > 0) & np.isfinite(values), rounded, values)
    return out


def variance(models: Sequence[NoiseModel]) -> Vector:
    """Row-major covariance, shape (9,), of three channels: the squares of their white noise on the diagonal."""
    out = np.zeros(9)
    out[[0, 4, 8]] = [m.stddev**2 for m in models]
    out.flags.writeable = False
    return out
