"""Gaussian noise of the file: white noise, a bias drawn once, biases that wander, quantisation.

Differs from Gazebo on purpose, unless the world asks for its quirks: the bias keeps the sign the file gives it, and a
wandering bias uses the true time between samples everywhere. What a data sheet says of white noise and of biases can be
written as it stands there (see `NoiseModel`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from operator import add, mul
from typing import TYPE_CHECKING

import numpy as np

from simkit.params import LARGEST, Params
from simkit.pose import Vector
from simkit.sensors.bias_drift import (
    BiasDriftGenerator,
    NoiseInterval,
    NoiseState,
    gauss_markov_drift,
    instability_drift,
)

if TYPE_CHECKING:
    from simkit.runtime.engine.random_streams import RandomStream, RandomStreams

_TYPES = ("none", "gaussian", "gaussian_quantized")
_DATA_SHEET_ELEMENTS = ("noise_density", "random_walk", "bias_instability", "correlation_time")
_DYNAMIC_BIAS_ELEMENTS = ("dynamic_bias_stddev", "dynamic_bias_correlation_time")
_MIN_PRECISION = 1e-6  # Gazebo takes a smaller one for none
_MAX_INTERVALS = 64  # kept; a jittered sensor has ever new ones


@dataclass(frozen=True, slots=True)
class NoiseModel:
    """Noise of one channel, in the channel's unit.

    Attributes:
        mean, stddev: of the white noise.
        bias_mean, bias_stddev: of the bias, drawn once.
        dynamic_bias_stddev: driving noise [unit/√s] of Gazebo's wandering bias, which begins at the drawn one.
        dynamic_bias_correlation_time: its correlation time [s]; 0 is none of it.
        precision: step of the quantisation, 0 for none.
        noise_density: N [unit/√Hz] of a data sheet; the white noise of samples dt apart is N/√dt.
        random_walk: K [unit/√s, the same as unit·√Hz] of a bias that starts at zero.
        bias_instability: B [unit]; 0.664·B is the floor of the Allan deviation.
        correlation_time: T [s] of the bias instability where there is one, else of the random walk, which it bounds; 0
            is none: an instability is flicker noise then, a walk has no bound.
        is_quantized: whether the type is `gaussian_quantized`.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0
    precision: float = 0.0
    noise_density: float = 0.0
    random_walk: float = 0.0
    bias_instability: float = 0.0
    correlation_time: float = 0.0
    is_quantized: bool = False

    @property
    def wanders(self) -> bool:
        """Whether its bias changes from sample to sample."""
        dynamic = self.dynamic_bias_stddev > 0 and self.dynamic_bias_correlation_time > 0
        return dynamic or self.random_walk > 0 or self.bias_instability > 0

    def white(self, interval: float) -> float:
        """Standard deviation of the white noise of samples `interval` [s] apart."""
        return self.noise_density / math.sqrt(interval) if self.noise_density > 0 else self.stddev

    def as_gazebo(self, has_dynamic_bias: bool) -> NoiseModel:
        """What Gazebo makes of it, but for the sign of the bias; what is our own stays."""
        dynamic = self.dynamic_bias_stddev if has_dynamic_bias else 0.0
        precision = self.precision if self.precision > _MIN_PRECISION else 0.0
        return replace(self, dynamic_bias_stddev=dynamic, precision=precision)


_NUMBERS = tuple(field.name for field in fields(NoiseModel) if field.name != "is_quantized")
_SIGNED = ("mean", "bias_mean")
_UNBOUNDED = ("dynamic_bias_correlation_time", "precision", "correlation_time")

NO_NOISE = NoiseModel()
ThreeAxes = tuple[NoiseModel, NoiseModel, NoiseModel]


def read_noise(owner: Params, default: str = "none") -> NoiseModel:
    """The `<noise>` of a block; its type may be an attribute or an element.

    With none of the two it is `default`, unless it is in a data sheet's words, which SDF has not.

    Args:
        default: SDF's for this block: `gaussian` for rays and cameras, `none` for everything else.
    """
    params = owner.child("noise")
    if params is None:
        return NO_NOISE
    in_our_words = any(params.has(name) for name in _DATA_SHEET_ELEMENTS)
    given = params.attribute("type") or params.text("type", "")
    kind = given or ("gaussian" if in_our_words else default)
    if kind not in _TYPES:
        params.error("SK-PARAM-002", f"found noise of type {kind!r}, allowed is {', '.join(_TYPES)}")
    if kind == "none":
        if not given and any(_is_nonzero_or_text(child.value) for child in params.children):
            hint = 'write <noise type="gaussian">'
            params.diagnostics.warning("SK-SENSOR-020", "<noise> without a type is none", params.where, hint)
        params.mark_all_read()
        return NO_NOISE
    values = {}
    for name in _NUMBERS:
        lowest = -LARGEST if name in _SIGNED else 0
        values[name] = params.number(name, 0.0, minimum=lowest, maximum=None if name in _UNBOUNDED else LARGEST)
    model = NoiseModel(**values, is_quantized=kind == "gaussian_quantized")
    return _prefer_data_sheet(model, params) if in_our_words else model


def read_axes(block: Params, otherwise: NoiseModel = NO_NOISE) -> ThreeAxes:
    """The `<noise>` of each of `<x>`, `<y>`, `<z>` of a block; `otherwise` for those that have none."""
    x, y, z = (read_noise(block.block(axis)) if block.block(axis).has("noise") else otherwise for axis in "xyz")
    return x, y, z


def _is_nonzero_or_text(text: str) -> bool:
    try:
        return float(text) != 0
    except ValueError:
        return bool(text)


def _prefer_data_sheet(model: NoiseModel, params: Params) -> NoiseModel:
    """A data sheet's form in place of Gazebo's where both say the same, which is reported."""
    if model.noise_density > 0 and model.stddev > 0:
        _report_duplicate(params, "<stddev>", "<noise_density>")
        model = replace(model, stddev=0.0)
    wandering = next((name for name in ("random_walk", "bias_instability") if getattr(model, name) > 0), "")
    if wandering and model.dynamic_bias_stddev > 0:
        _report_duplicate(params, f"<{_DYNAMIC_BIAS_ELEMENTS[0]}>", f"<{wandering}>")
        model = replace(model, dynamic_bias_stddev=0.0)
    if model.correlation_time > 0 and not wandering:
        message = "<correlation_time> is of a <random_walk> or a <bias_instability>, there is none"
        params.diagnostics.warning("SK-SENSOR-021", message, params.block("correlation_time").where)
    return model


def _report_duplicate(params: Params, gazebos: str, ours: str) -> None:
    message = f"{gazebos} is not used: {ours} says the same, as a data sheet does"
    params.diagnostics.warning("SK-SENSOR-021", message, params.where, "leave one of the two out of this <noise>")


class Noise:
    """The noise of a group of channels.

    A sample's draw depends on its index; what has no deviation draws nothing.

    Args:
        models: one per channel.
        streams: the simulation's.
        scoped: the sensor's name.
        group: names the group's streams.
        interval: nominal time between two samples [s], that of a first sample, which has none before it.
        random_sign: each channel's bias has either sign, with equal odds (Gazebo's).

    Attributes:
        state: what of it depends on the sample; samples that wait to be finished keep theirs.
    """

    state: NoiseState

    def __init__(
        self,
        models: Sequence[NoiseModel],
        streams: RandomStreams,
        scoped: str,
        group: str,
        *,
        interval: float = 0.001,
        random_sign: bool = False,
    ) -> None:
        def column(name: str) -> Vector:
            return np.array([getattr(m, name) for m in models], dtype=np.float64)

        self.models, self.width = tuple(models), len(models)
        self._mean, self._precision = column("mean"), column("precision")
        self._bias_mean, self._bias_stddev = column("bias_mean"), column("bias_stddev")
        self._is_quantised = bool(self._precision.any())
        self._white = self._open_white_noise(streams, scoped, group)
        self._drawn_bias = streams.stream(scoped, group + "/bias", self.width) if self._bias_stddev.any() else None
        has_bias = self._bias_mean.any() or self._bias_stddev.any()
        self._sign = streams.stream(scoped, group + "/sign", self.width) if random_sign and has_bias else None
        times = column("dynamic_bias_correlation_time")
        dynamic = np.where(times > 0, column("dynamic_bias_stddev"), 0.0)
        self._is_dynamic = dynamic > 0
        # a correlation time is of the instability where there is one
        unstable, bound = column("bias_instability"), column("correlation_time")
        walks = gauss_markov_drift(
            column("random_walk").tolist(), np.where(unstable > 0, 0.0, bound).tolist(), "random_walk"
        )
        parts = (gauss_markov_drift(dynamic.tolist(), times.tolist(), "walk"), walks)
        self._wanderer = BiasDriftGenerator(
            (*parts, instability_drift(unstable.tolist(), bound.tolist(), "instability")), streams, scoped, group
        )
        self._has_density = any(m.noise_density > 0 for m in models)
        self.wanders = bool(self._wanderer.wanders) or self._has_density
        self._intervals: dict[float, NoiseInterval] = {}
        self._nominal = interval
        self.restart()
        # what shows in no digit is left out
        self.is_silent = not (
            self._white or self._wanderer.wanders or self._is_quantised or bool(self.state.constant.any())
        )

    def _open_white_noise(self, streams: RandomStreams, scoped: str, group: str) -> RandomStream | None:
        is_white = any(m.stddev > 0 or m.noise_density > 0 for m in self.models)
        return streams.stream(scoped, group, self.width) if is_white else None

    def set_interval(self, interval: float) -> None:
        """Says that samples are `interval` [s] apart from now on, if nothing else is known of one."""
        self._nominal = interval

    def restart(self) -> None:
        """Draws what is drawn once."""
        bias = self._bias_mean.copy()
        if self._drawn_bias is not None:
            bias += self._bias_stddev * self._drawn_bias.normal(0)
        if self._sign is not None:
            bias = np.where(self._sign.normal(0) < 0, -bias, bias)
        self._fixed = np.where(self._is_dynamic, 0.0, bias) + self._mean
        parts = self._wanderer.begin()
        if self._is_dynamic.any():
            parts = (parts[0] + np.where(self._is_dynamic, bias, 0.0), *parts[1:])
        self._replace(self._of(self._nominal), parts)

    def evolve(self, index: int, dt: float) -> None:
        """Moves on by `dt` [s] to sample `index`; 0 where there is no sample before it."""
        before = self.state
        interval = self._of(dt if dt > 0 else self._nominal)
        if dt > 0 and before.parts:
            self._replace(interval, self._wanderer.step(before.parts, interval.factors, index))
        elif interval is not before.interval:
            self.state = NoiseState(interval, before.parts, before.constant)

    def _replace(self, interval: NoiseInterval, parts: tuple[Vector, ...]) -> None:
        constant = self._fixed
        for moved in self._wanderer.sums(parts):
            constant = constant + moved
        self.state = NoiseState(interval, parts, constant)

    def _of(self, dt: float) -> NoiseInterval:
        known = self._intervals.get(dt)
        if known is None:
            if len(self._intervals) >= _MAX_INTERVALS:
                self._intervals.clear()
            stddev = np.array([m.white(dt) for m in self.models])
            known = self._intervals[dt] = NoiseInterval(stddev, self._wanderer.factors(dt))
        return known

    def apply(self, values: Vector, index: int) -> Vector:
        """The values, shape (width,), of sample `index` with noise; infinite ones stay."""
        state = self.state
        out: Vector = values + state.constant
        if self._white is not None:
            out += state.interval.stddev * self._white.normal(index)
        if self._is_quantised:
            out = quantise(out, self._precision)
        return out

    def apply_to_numbers(self, values: Sequence[float], index: int) -> Sequence[float]:
        """The same bits as `apply`, for so few numbers that they are sooner added one by one than by NumPy."""
        if self._is_quantised:
            rounded: list[float] = self.apply(np.array(values), index).tolist()
            return rounded
        constant, stddev = self.state.numbers
        if self._white is None:
            return list(map(add, values, constant))
        white = self._white.normal(index).tolist()
        return list(map(add, map(add, values, constant), map(mul, stddev, white)))

    def covariance(self, first: int = 0) -> Vector:
        """Row-major covariance, shape (9,), of the white noise of three channels from `first` on; not to be written."""
        made = self.state.interval.covariances
        found = made.get(first)
        if found is None:
            found = made[first] = np.zeros(9)
            found[[0, 4, 8]] = self.state.interval.stddev[first : first + 3] ** 2
            found.flags.writeable = False
        return found

    def variance(self, channel: int = 0) -> float:
        """Variance of the white noise of a channel."""
        return float(self.state.interval.stddev[channel]) ** 2

    @property
    def offset(self) -> float:
        """What the first channel has besides white noise."""
        return float(self.state.constant[0])


class UniformNoise(Noise):
    """The same noise model on every one of many channels (a lidar's rays); one bias for all.

    Args:
        width: channels.
    """

    def __init__(
        self,
        model: NoiseModel,
        width: int,
        streams: RandomStreams,
        scoped: str,
        group: str,
        *,
        interval: float = 0.001,
        random_sign: bool = False,
    ) -> None:
        self.model, self._rays = model, width
        self._rays_group = group
        super().__init__([model], streams, scoped, group + "/shared", interval=interval, random_sign=random_sign)
        self.width = width

    def _open_white_noise(self, streams: RandomStreams, scoped: str, group: str) -> RandomStream | None:
        is_white = self.model.stddev > 0 or self.model.noise_density > 0
        return streams.stream(scoped, self._rays_group, self._rays) if is_white else None

    def apply(self, values: Vector, index: int) -> Vector:
        """The values, shape (width,), with noise; infinite ones stay infinite."""
        state = self.state
        if self._white is not None:
            out = self._white.normal(index) * state.interval.stddev
            out += values
        else:
            out = values.copy()
        if state.constant[0]:
            out += state.constant
        if self._is_quantised:
            out = quantise(out, self._precision)
        return out


def quantise(values: Vector, precision: Vector) -> Vector:
    """To multiples of `precision` (where it is not 0), halves away from zero."""
    step = np.where(precision > 0, precision, 1.0)
    with np.errstate(invalid="ignore", over="ignore"):
        rounded = np.copysign(np.floor(np.abs(values) / step + 0.5) * step, values)
    # what has more steps in it than there are numbers is as good as rounded
    out: Vector = np.where((precision > 0) & np.isfinite(rounded), rounded, values)
    return out
