"""Gaussian noise of sensors: white noise, a bias drawn once, biases that drift, and quantisation.

Two properties differ from Gazebo unless the world sets `<gazebo_quirks>`: the bias keeps the sign of the file, and a
drifting bias always uses the true time between samples. A file can contain a data sheet's numbers for white noise and
biases without conversion (see `NoiseModel`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from operator import add, mul
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit.argument_checks import check_list, checked_number, wrong_value
from simkit.errors import InputError
from simkit.params import LARGEST, Params
from simkit.pose import Vector
from simkit.sensors.bias_drift import (
    BiasDriftGenerator,
    NoiseInterval,
    NoiseState,
    gauss_markov_drift,
    instability_drift,
)
from simkit.sensors.sample import Memory, NoiseProcess, Reading, ReadingFunction, Sample

if TYPE_CHECKING:
    from simkit.runtime.engine.random_streams import RandomStream, RandomStreams


_TYPES = ("none", "gaussian", "gaussian_quantized")
_DATA_SHEET_ELEMENTS = ("noise_density", "random_walk", "bias_instability", "correlation_time")
_DYNAMIC_BIAS_ELEMENTS = ("dynamic_bias_stddev", "dynamic_bias_correlation_time")
_MIN_PRECISION = 1e-6  # Gazebo ignores a smaller precision
_PREPARED = 32  # samples whose white noise is computed at a time
_MAX_INTERVALS = 64  # size of the cache of intervals, because each interval differs if the sensor has jitter


@dataclass(frozen=True, slots=True)
class NoiseModel:
    """Noise of one channel, in the channel's unit.

    Attributes:
        mean, stddev: mean and standard deviation of the white noise.
        bias_mean, bias_stddev: mean and standard deviation of the bias, which is drawn once.
        dynamic_bias_stddev: driving noise [unit/√s] of Gazebo's drifting bias, which starts at the drawn bias.
        dynamic_bias_correlation_time: correlation time [s] of that bias; 0 disables the drift.
        precision: step of the quantisation; 0 for none.
        noise_density: N [unit/√Hz] of a data sheet; the white noise of samples dt apart is N/√dt.
        random_walk: K [unit/√s, the same as unit·√Hz] of a bias that starts at zero.
        bias_instability: B [unit]; 0.664·B is the floor of the Allan deviation.
        correlation_time: T [s] of the bias instability if there is one, else of the random walk, which T bounds.
            With 0, an instability is flicker noise and a random walk has no bound.
        is_quantized: True for the type `gaussian_quantized`.
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
    def drifts(self) -> bool:
        """True if the bias drifts from sample to sample."""
        dynamic = self.dynamic_bias_stddev > 0 and self.dynamic_bias_correlation_time > 0
        return dynamic or self.random_walk > 0 or self.bias_instability > 0

    def white(self, interval: float) -> float:
        """Return the standard deviation of the white noise of samples `interval` [s] apart."""
        return self.noise_density / math.sqrt(interval) if self.noise_density > 0 else self.stddev

    def as_gazebo(self, has_dynamic_bias: bool) -> NoiseModel:
        """Return the noise as Gazebo applies it, except for the sign of the bias; keep simkit's own elements."""
        dynamic = self.dynamic_bias_stddev if has_dynamic_bias else 0.0
        precision = self.precision if self.precision > _MIN_PRECISION else 0.0
        return replace(self, dynamic_bias_stddev=dynamic, precision=precision)


_NUMBERS = tuple(field.name for field in fields(NoiseModel) if field.name != "is_quantized")
_SIGNED = ("mean", "bias_mean")
_UNBOUNDED = ("dynamic_bias_correlation_time", "precision", "correlation_time")

NO_NOISE = NoiseModel()
ThreeAxes = tuple[NoiseModel, NoiseModel, NoiseModel]


def read_noise(owner: Params, default: str = "none") -> NoiseModel:
    """Read the `<noise>` of a block; the type may be an attribute or an element.

    Without a type, `default` applies. A noise with data-sheet elements, which are simkit's own, is always `gaussian`.

    Args:
        owner: block that contains the `<noise>`.
        default: default of SDF for this block: `gaussian` for rays and cameras, `none` for everything else.
    """
    params = owner.child("noise")
    if params is None:
        return NO_NOISE
    is_data_sheet = any(params.has(name) for name in _DATA_SHEET_ELEMENTS)
    type_name = params.attribute("type") or params.text("type", "")
    kind = type_name or ("gaussian" if is_data_sheet else default)
    if kind not in _TYPES:
        params.error("SK-PARAM-002", f"found noise of type {kind!r}; expected {', '.join(_TYPES)}")
    if kind == "none":
        if not type_name and any(_is_nonzero_or_text(child.value) for child in params.children):
            params.warning("SK-SENSOR-020", "<noise> without a type adds no noise", 'write <noise type="gaussian">')
        params.mark_all_read()
        return NO_NOISE
    values = {}
    for name in _NUMBERS:
        lowest = -LARGEST if name in _SIGNED else 0
        values[name] = params.number(name, 0.0, minimum=lowest, maximum=None if name in _UNBOUNDED else LARGEST)
    model = NoiseModel(**values, is_quantized=kind == "gaussian_quantized")
    return _prefer_data_sheet(model, params) if is_data_sheet else model


def read_axes(block: Params, default: NoiseModel = NO_NOISE) -> ThreeAxes:
    """Read the `<noise>` of `<x>`, `<y>` and `<z>` of a block; an axis without `<noise>` gets `default`."""
    x, y, z = (read_noise(block.block(axis)) if block.block(axis).has("noise") else default for axis in "xyz")
    return x, y, z


def _is_nonzero_or_text(text: str) -> bool:
    try:
        return float(text) != 0
    except ValueError:
        return bool(text)


def _prefer_data_sheet(model: NoiseModel, params: Params) -> NoiseModel:
    """Drop Gazebo's parameters where the data-sheet parameters define the same noise, and report them."""
    if model.noise_density > 0 and model.stddev > 0:
        _report_duplicate(params, "<stddev>", "<noise_density>")
        model = replace(model, stddev=0.0)
    drift_element = next((name for name in ("random_walk", "bias_instability") if getattr(model, name) > 0), "")
    if drift_element and model.dynamic_bias_stddev > 0:
        _report_duplicate(params, f"<{_DYNAMIC_BIAS_ELEMENTS[0]}>", f"<{drift_element}>")
        model = replace(model, dynamic_bias_stddev=0.0)
    if model.correlation_time > 0 and not drift_element:
        message = "<correlation_time> has no effect without a <random_walk> or a <bias_instability>"
        params.diagnostics.warning("SK-SENSOR-021", message, params.block("correlation_time").where)
    return model


def _report_duplicate(params: Params, unused: str, used: str) -> None:
    message = f"{unused} is not used: {used} defines the same noise"
    params.diagnostics.warning("SK-SENSOR-021", message, params.where, "remove one of the two from this <noise>")


class Noise:
    """Noise of a group of channels.

    The random numbers of a sample depend on its index only. Noise whose standard deviation is 0 draws no numbers.

    Args:
        models: noise models, one per channel.
        streams: random streams of the simulation.
        scoped: scoped name of the sensor.
        group: name of the group, which names its streams.
        interval: nominal time between two samples [s], used for the first sample.
        random_sign: True gives each channel's bias either sign with equal odds, as Gazebo does.

    Attributes:
        state: state at the newest sample; a sample that is finished later has a reference to its own state.
        white: random stream of the white noise; None without it.
        is_quantised: True if the values are rounded.
    """

    state: NoiseState
    _prepared: tuple[object, int, list[list[float]]] = (None, 0, [])  # white noise of the next samples, and its first

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
        self._origin, self._nominal, self._has_random_sign = (streams, scoped, group), interval, random_sign
        self.change(models)

    def change(self, models: Sequence[NoiseModel]) -> None:
        """Use other noise models, as many as before; constant biases are drawn as at t = 0."""
        streams, scoped, group = self._origin

        def column(name: str) -> Vector:
            return np.array([getattr(m, name) for m in models], dtype=np.float64)

        self.models, self.width = tuple(models), len(models)
        self._mean, self._precision = column("mean"), column("precision")
        self._bias_mean, self._bias_stddev = column("bias_mean"), column("bias_stddev")
        self.is_quantised = bool(self._precision.any())
        self.white = self._open_white_noise(streams, scoped, group)
        self._drawn_bias = streams.stream(scoped, group + "/bias", self.width) if self._bias_stddev.any() else None
        has_bias = self._bias_mean.any() or self._bias_stddev.any()
        has_sign = self._has_random_sign and has_bias
        self._sign = streams.stream(scoped, group + "/sign", self.width) if has_sign else None
        times = column("dynamic_bias_correlation_time")
        dynamic = np.where(times > 0, column("dynamic_bias_stddev"), 0.0)
        self._is_dynamic = dynamic > 0
        # a correlation time belongs to the instability if there is one
        unstable, bound = column("bias_instability"), column("correlation_time")
        walks = gauss_markov_drift(
            column("random_walk").tolist(), np.where(unstable > 0, 0.0, bound).tolist(), "random_walk"
        )
        drifts = (gauss_markov_drift(dynamic.tolist(), times.tolist(), "walk"), walks)
        self._bias_drift = BiasDriftGenerator(
            (*drifts, instability_drift(unstable.tolist(), bound.tolist(), "instability")), streams, scoped, group
        )
        self._has_density = any(m.noise_density > 0 for m in models)
        self.evolves = bool(self._bias_drift.drifts) or self._has_density
        self._intervals: dict[float, NoiseInterval] = {}
        self._start: NoiseState | None = None
        self._has_fixed_start = self._drawn_bias is None and self._sign is None and not self._bias_drift.drifts
        self.restart()
        # noise without any effect is skipped
        self.is_silent = not (
            self.white or self._bias_drift.drifts or self.is_quantised or bool(self.state.constant.any())
        )

    def _open_white_noise(self, streams: RandomStreams, scoped: str, group: str) -> RandomStream | None:
        is_white = any(m.stddev > 0 or m.noise_density > 0 for m in self.models)
        return streams.stream(scoped, group, self.width) if is_white else None

    def set_interval(self, interval: float) -> None:
        """Set the time between samples [s] that the first sample uses, because it has no previous sample."""
        self._nominal = interval

    def restart(self) -> None:
        """Return to t = 0, and draw the constant biases again."""
        if self._start is not None and self._start.interval is self._of(self._nominal):
            self.state = self._start
            return
        bias = self._bias_mean.copy()
        if self._drawn_bias is not None:
            bias += self._bias_stddev * self._drawn_bias.normal(0)
        if self._sign is not None:
            bias = np.where(self._sign.normal(0) < 0, -bias, bias)
        self._fixed = np.where(self._is_dynamic, 0.0, bias) + self._mean
        biases = self._bias_drift.begin()
        if self._is_dynamic.any():
            biases = (biases[0] + np.where(self._is_dynamic, bias, 0.0), *biases[1:])
        self._replace(self._of(self._nominal), biases)
        if self._has_fixed_start:
            self._start = self.state

    def evolve(self, index: int, dt: float) -> None:
        """Advance by `dt` [s] to sample `index`; `dt` is 0 for the first sample."""
        before = self.state
        interval = self._of(dt if dt > 0 else self._nominal)
        if dt > 0 and before.biases:
            self._replace(interval, self._bias_drift.step(before.biases, interval.factors, index))
        elif interval is not before.interval:
            self.state = NoiseState(interval, before.biases, before.constant)

    def _replace(self, interval: NoiseInterval, biases: tuple[Vector, ...]) -> None:
        constant = self._fixed
        for moved in self._bias_drift.sums(biases):
            constant = constant + moved
        self.state = NoiseState(interval, biases, constant)

    def _of(self, dt: float) -> NoiseInterval:
        known = self._intervals.get(dt)
        if known is None:
            if len(self._intervals) >= _MAX_INTERVALS:
                self._intervals.clear()
            stddev = np.array([m.white(dt) for m in self.models])
            known = self._intervals[dt] = NoiseInterval(stddev, self._bias_drift.factors(dt))
        return known

    def apply(self, values: Vector, index: int) -> Vector:
        """Return the values of sample `index`, shape (width,), with noise; infinite values stay infinite."""
        return self._add(values, self.state, None if self.white is None else self.white.normal(index))

    def _add(self, values: Vector, state: NoiseState, normals: Vector | None) -> Vector:
        """Return values with noise, shape (width,) or (samples, width).

        Args:
            values: values without noise.
            state: state of the noise.
            normals: standard normal numbers of the white noise, one for each value; None without white noise.
        """
        out = with_noise(values, state.constant, state.interval.stddev, normals)
        return quantise(out, self._precision) if self.is_quantised else out

    def rows(self, count: int) -> NoiseRows:
        """Return the noise of this sensor in n simulations."""
        return NoiseRows(self, count)

    def apply_to_numbers(self, values: Sequence[float], index: int) -> Sequence[float]:
        """Return the same bits as `apply`, faster for a few numbers because each is added without NumPy."""
        if self.is_quantised:
            rounded: list[float] = self.apply(np.array(values), index).tolist()
            return rounded
        state, white = self.state, self.white
        constant, stddev = state.numbers
        if white is None:
            return list(map(add, values, constant))
        if self.evolves:
            return list(map(add, map(add, values, constant), map(mul, stddev, white.normal(index).tolist())))
        made_of, first, rows = self._prepared
        row = index - first
        if made_of != (state, white.seed) or not 0 <= row < len(rows):
            rows, row = (state.interval.stddev * white.normals(index, _PREPARED)).tolist(), 0
            self._prepared = (state, white.seed), index, rows
        return list(map(add, map(add, values, constant), rows[row]))

    def apply_to_samples(self, values: Vector, first: int) -> Vector:
        """Return the values of consecutive samples, shape (n, width), with the same bits as `apply` for each of them.

        Args:
            values: values without noise.
            first: number of the first sample.
        """
        white = self.white
        if white is None:
            return self._add(values, self.state, None)
        parts: list[Vector] = []
        while (done := sum(map(len, parts))) < len(values):
            parts.append(white.normals(first + done, len(values) - done))
        return self._add(values, self.state, np.concatenate(parts))

    def covariance(self, first_channel: int = 0) -> Vector:
        """Return the read-only row-major covariance, shape (9,), of the white noise of three channels."""
        covariances = self.state.interval.covariances
        covariance = covariances.get(first_channel)
        if covariance is None:
            covariance = covariances[first_channel] = np.zeros(9)
            covariance[[0, 4, 8]] = self.state.interval.stddev[first_channel : first_channel + 3] ** 2
            covariance.flags.writeable = False
        return covariance

    def variance(self, channel: int = 0) -> float:
        """Return the variance of the white noise of a channel."""
        return float(self.state.interval.stddev[channel]) ** 2

    @property
    def offset(self) -> float:
        """Sum of all noise of the first channel except white noise."""
        return float(self.state.constant[0])


class UniformNoise(Noise):
    """Noise with the same model on each of many channels (the rays of a lidar) and one bias for all of them.

    Args:
        width: number of channels.
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

    def change(self, models: Sequence[NoiseModel]) -> None:
        """Use another noise model on all channels; a constant bias is drawn as at t = 0."""
        (self.model,) = models
        super().change(models)
        self.width = self._rays

    def _open_white_noise(self, streams: RandomStreams, scoped: str, group: str) -> RandomStream | None:
        is_white = self.model.stddev > 0 or self.model.noise_density > 0
        return streams.stream(scoped, self._rays_group, self._rays) if is_white else None

    def _add(self, values: Vector, state: NoiseState, normals: Vector | None) -> Vector:
        if normals is not None:
            out: Vector = normals * state.interval.stddev
            out += values
        else:
            out = values.copy()
        if state.constant[0]:
            out += state.constant
        return quantise(out, self._precision) if self.is_quantised else out


class NoiseRows:
    """Noise of one sensor in n simulations, each with the seed of its own episode.

    Args:
        noise: noise of the sensor of the simulation that resets all others; it must not drift.
        count: number of simulations.
    """

    def __init__(self, noise: Noise, count: int) -> None:
        self._noise = noise
        self._rows: list[tuple[NoiseState, RandomStream | None]] = [(noise.state, None)] * count

    def take(self, row: int) -> None:
        """Copy the present noise to one row."""
        white = self._noise.white
        self._rows[row] = self._noise.state, None if white is None else white.independent_copy()

    def apply(self, values: Vector, ids: npt.NDArray[np.intp], index: npt.NDArray[np.int64]) -> None:
        """Add the noise to some rows of values, shape (n, width), in place.

        Args:
            values: values without noise.
            ids: rows to change.
            index: number of the sample of each row, shape (n,).
        """
        if self._noise.is_silent:
            return
        for row, number in zip(ids.tolist(), index[ids].tolist(), strict=True):
            state, white = self._rows[row]
            values[row] = self._noise._add(values[row], state, None if white is None else white.normal(number))


def with_noise(values: Vector, constant: Vector, stddev: Vector, normals: Vector | None) -> Vector:
    """Return values with a constant error and white noise; all arrays have the same shape, or one that broadcasts.

    Args:
        values: values without noise.
        constant: sum of all noise except white noise.
        stddev: standard deviation of the white noise.
        normals: standard normal numbers; None without white noise.
    """
    out: Vector = values + constant
    if normals is not None:
        out += stddev * normals
    return out


def quantise(values: Vector, precision: Vector) -> Vector:
    """Round values to multiples of `precision`, halves away from zero; a precision of 0 changes nothing."""
    step = np.where(precision > 0, precision, 1.0)
    with np.errstate(invalid="ignore", over="ignore"):
        rounded = np.copysign(np.floor(np.abs(values) / step + 0.5) * step, values)
    # a value of so many steps that the product overflows stays as it is
    out: Vector = np.where((precision > 0) & np.isfinite(rounded), rounded, values)
    return out


class SettableNoise:
    """Attribute with the noise of a sensor's channels; a noise model, or a number, that is set changes the noise."""

    def __get__(self, sensor: NoiseKeeper | None, owner: type) -> Any:
        return self if sensor is None else vars(sensor).get("_noise")

    def __set__(self, sensor: NoiseKeeper, value: Any) -> None:
        if value is None or isinstance(value, Noise):
            vars(sensor)["_noise"] = value  # the kind makes its noise
        else:
            sensor.change_noise(value)


class NoiseKeeper:
    """Base class of `Sampler` with the sensor's noise processes, which advance, restart and are restored together."""

    scoped: str

    def __init__(self) -> None:
        self._noises: list[NoiseProcess] = []
        self._evolving: tuple[NoiseProcess, ...] = ()

    def change_noise(self, value: float | NoiseModel | Sequence[NoiseModel]) -> None:
        """Change the noise: a standard deviation or a model for all channels, or a model for each channel.

        Raises:
            InputError: SK-CORE-006 the sensor has no noise of channels, as an image.
        """
        noises = self._channel_noises()
        if not noises:
            help_ = f"set it before the load, with overrides=['{self.scoped}.….noise.stddev=…']"
            message = f"the noise of sensor {self.scoped!r} cannot change during a run"
            raise InputError("SK-CORE-006", message, help=help_)
        count = sum(len(noise.models) for noise in noises)
        if isinstance(value, NoiseModel):
            models = [value] * count
        elif isinstance(value, (int, float)):
            models = [NoiseModel(stddev=checked_number(value, "noise", 0.0))] * count
        else:
            check_list(value, NoiseModel, "noise", "noise models")
            models = list(value)
        if len(models) != count:
            raise wrong_value("noise", f"a number, a NoiseModel or {count} NoiseModels", value)
        self._finish_kept_samples()
        for noise in noises:
            noise.change(models[: len(noise.models)])
            models = models[len(noise.models) :]
        self._noise_changed()

    def noise_models(self) -> list[NoiseModel]:
        """Return the noise model of each channel."""
        return [model for noise in self._channel_noises() for model in noise.models]

    def _channel_noises(self) -> list[Noise]:
        """Return the noise of the measured values; an IMU's orientation, for example, has further noise."""
        main: Noise | None = vars(self).get("_noise")
        return [main] if main is not None else [noise for noise in self._noises if isinstance(noise, Noise)]

    def _finish_kept_samples(self) -> None:
        """Finish the samples that still need the noise of their time."""

    def _noise_changed(self) -> None:
        """Adapt to changed noise."""
        self._evolving = tuple(noise for noise in self._noises if noise.evolves)

    def evolve(self, index: int, dt: float) -> None:
        """Advance noise that has a state by `dt` [s], also for samples without a reader; 0 at the first sample."""
        for noise in self._noises:
            if noise.evolves:
                noise.evolve(index, dt)

    def restart(self) -> None:
        """Return to t = 0, and draw the constant biases again."""
        for noise in self._noises:
            noise.restart()

    def memory(self) -> object:
        """Return the state that continues from sample to sample, as values that are never modified."""
        return tuple((noise.state, getattr(noise, "models", ())) for noise in self._noises)

    def remember(self, memory: Memory) -> None:
        """Restore the state that `memory` returned."""
        is_changed = False
        for noise, (state, models) in zip(self._noises, memory, strict=True):
            if isinstance(noise, Noise) and noise.models != models:
                noise.change(models)
                is_changed = True
            noise.state = state
        if is_changed:
            self._noise_changed()

    def _with_noise_of(self, sample: Sample, make: ReadingFunction, reading: Reading, number: int) -> object:
        """Call `make(reading, number)` while the noise has its state of that sample."""
        now = [noise.state for noise in self._evolving]
        for noise, state in zip(self._evolving, sample.noise_states, strict=True):
            noise.state = state
        try:
            return make(reading, number)
        finally:
            for noise, state in zip(self._evolving, now, strict=True):
                noise.state = state
