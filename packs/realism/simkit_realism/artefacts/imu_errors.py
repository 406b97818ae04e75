"""Errors of inertial units besides noise: scale and misalignment, bandwidth, and the measuring range."""

from __future__ import annotations

import math
from collections.abc import Sequence

from simkit import Params
from simkit.elementary_functions import tan
from simkit.extend import Artefact, ImuMeasurement, ImuReading, Sensor

QUANTITIES = ("angular_velocity", "linear_acceleration")
_DIAGONAL, _OTHERS = (0, 4, 8), (1, 2, 3, 5, 6, 7)  # places in a row-major 3×3 matrix
_BUTTERWORTH = math.sqrt(2.0)  # damping term of the second-order low pass with a flat response

Numbers = tuple[float, ...]


class CalibrationError(Artefact):
    """`<simkit:calibration_error>` of an IMU: scale factors and misaligned axes of gyroscope and accelerometer.

    Each vector is multiplied by I + E before the noise. The drawn parts of E are constant during a run.

    Args:
        params: the element, with `angular_velocity` and `linear_acceleration`. Each has `scale`, the relative error of
            x, y and z, the diagonal of E; `misalignment` [rad], the elements xy, xz, yx, yz, zx and zy of E; and
            `scale_stddev` and `misalignment_stddev` [rad] of further parts that the seed draws.
        sensor: the IMU.

    Attributes:
        state: matrix I + E of each quantity, row by row.
    """

    elements = ("imu/calibration_error",)
    order = -10.0
    evolves = False
    state: tuple[Numbers, Numbers]

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._means: list[Numbers] = []
        self._stddevs: list[Numbers] = []
        for quantity in QUANTITIES:
            block = params.block(quantity)
            scale = block.vector("scale", 3, (0.0,) * 3)
            misalignment = block.vector("misalignment", 6, (0.0,) * 6)
            spreads = [block.number(name, 0.0, minimum=0.0, maximum=1.0) for name in _SPREADS]
            self._means.append(_matrix(scale, misalignment))
            self._stddevs.append(_matrix([spreads[0]] * 3, [spreads[1]] * 6))

    def prepare(self) -> None:
        self._stream = self.stream("matrices", 18)
        self.sensor.register_noise(self)

    def restart(self) -> None:
        numbers = self._stream.normal(0).tolist()
        matrices = []
        for row, (means, stddevs) in enumerate(zip(self._means, self._stddevs, strict=True)):
            drawn = numbers[9 * row : 9 * row + 9]
            parts = zip(_matrix((1.0,) * 3, (0.0,) * 6), means, stddevs, drawn, strict=True)
            matrices.append(tuple([one + (mean + stddev * normal) for one, mean, stddev, normal in parts]))
        self.state = (matrices[0], matrices[1])

    def evolve(self, index: int, dt: float) -> None:
        """Do nothing: the matrices are constant."""

    def set_interval(self, interval: float) -> None:
        """Do nothing: the matrices do not depend on the rate."""

    def apply(self, reading: ImuReading, truth: ImuReading, index: int) -> ImuReading:
        rate, force = self.state
        return ImuReading(reading.orientation, [*_turn(rate, reading.motion[:3]), *_turn(force, reading.motion[3:])])


_SPREADS = ("scale_stddev", "misalignment_stddev")


def _matrix(diagonal: Sequence[float], others: Sequence[float]) -> Numbers:
    """Return a 3×3 matrix, row by row, from its diagonal and its other elements."""
    places = dict(zip((*_DIAGONAL, *_OTHERS), (*diagonal, *others), strict=True))
    return tuple([places[place] for place in range(9)])


def _turn(matrix: Numbers, vector: Sequence[float]) -> list[float]:
    x, y, z = vector
    return [matrix[row] * x + matrix[row + 1] * y + matrix[row + 2] * z for row in (0, 3, 6)]


class Bandwidth(Artefact):
    """`<simkit:bandwidth>` of an IMU: low pass of the angular rate and of the specific force, before the noise.

    The filter runs at the samples of the sensor, with the bilinear transform. Its response is exactly -3 dB at the
    given frequency. Oscillations above half the rate of the sensor are folded to lower frequencies before the filter,
    as in an IMU without an analogue filter.

    Args:
        params: the element: `angular_velocity` and `linear_acceleration`, the -3 dB frequencies [Hz], 0 for no filter;
            `order`, 1 or 2. The second order is a Butterworth filter.
        sensor: the IMU.

    Attributes:
        state: filtered rate [rad/s] and specific force [m/s²], six numbers, and two memories of each filter; empty
            before the first sample.
    """

    elements = ("imu/bandwidth",)
    order = -20.0
    follows_truth = True
    evolves = True
    sensor: ImuMeasurement

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.frequencies = [params.number(name, 0.0, minimum=0.0) for name in QUANTITIES]
        self.filter_order = params.integer("order", 1, minimum=1, maximum=2)
        self.state: tuple[Numbers, Numbers, Numbers] | tuple[()] = ()
        self._coefficients: dict[tuple[float, float], Numbers] = {}
        for name, frequency in zip(QUANTITIES, self.frequencies, strict=True):
            if sensor.update_rate > 0 and frequency >= 0.5 * sensor.update_rate:
                message = f"<{name}>{frequency:g}</{name}> is not below half the rate of the sensor, and has no effect"
                params.block(name).warning("SK-SENSOR-246", message, f"write less than {0.5 * sensor.update_rate:g} Hz")

    def prepare(self) -> None:
        self.sensor.register_noise(self)

    def restart(self) -> None:
        self.state = ()

    def set_interval(self, interval: float) -> None:
        """Do nothing: each step has its own time."""

    def evolve(self, index: int, dt: float) -> None:
        sensor = self.sensor
        motion = sensor.measure(sensor.sim.mj_model, sensor.computed_data()).motion
        if not self.state or dt <= 0.0:
            self.state = (tuple(motion), *self._steady(motion, dt or 1.0 / max(sensor.update_rate, 1.0)))
            return
        outputs, firsts, seconds = [], [], []
        for channel, value in enumerate(motion):
            known = self._of(self.frequencies[channel // 3], dt)
            b0, b1, b2, a1, a2 = known
            # transposed direct form II
            output = b0 * value + self.state[1][channel]
            outputs.append(output)
            firsts.append(b1 * value - a1 * output + self.state[2][channel])
            seconds.append(b2 * value - a2 * output)
        self.state = (tuple(outputs), tuple(firsts), tuple(seconds))

    def _steady(self, motion: Sequence[float], dt: float) -> tuple[Numbers, Numbers]:
        """Return the memories of filters whose input has been constant."""
        firsts, seconds = [], []
        for channel, value in enumerate(motion):
            _, b1, b2, a1, a2 = self._of(self.frequencies[channel // 3], dt)
            firsts.append((b1 - a1 + b2 - a2) * value)
            seconds.append((b2 - a2) * value)
        return tuple(firsts), tuple(seconds)

    def _of(self, frequency: float, dt: float) -> Numbers:
        """Return b0, b1, b2, a1 and a2 of the low pass for a step of `dt` [s]."""
        known = self._coefficients.get((frequency, dt))
        if known is None:
            if len(self._coefficients) >= 64:  # each step differs if the sensor has jitter
                self._coefficients.clear()
            known = self._coefficients[frequency, dt] = low_pass(frequency, dt, self.filter_order)
        return known

    def apply(self, reading: ImuReading, truth: ImuReading, index: int) -> ImuReading:
        return ImuReading(reading.orientation, list(self.state[0])) if self.state else reading


def low_pass(frequency: float, dt: float, order: int) -> Numbers:
    """Return b0, b1, b2, a1 and a2 of a low pass with -3 dB at a frequency, from the bilinear transform.

    Args:
        frequency: frequency [Hz]; with 0, or from half the sampling rate on, the filter changes nothing.
        dt: time between two samples [s].
        order: 1, or 2 for Butterworth's filter.
    """
    if frequency <= 0.0 or frequency * dt >= 0.5:
        return (1.0, 0.0, 0.0, 0.0, 0.0)
    warped = tan(math.pi * frequency * dt)
    if order == 1:
        scale = 1.0 / (1.0 + warped)
        return (warped * scale, warped * scale, 0.0, (warped - 1.0) * scale, 0.0)
    square = warped * warped
    scale = 1.0 / (1.0 + _BUTTERWORTH * warped + square)
    b = square * scale
    return (b, 2.0 * b, b, 2.0 * (square - 1.0) * scale, (1.0 - _BUTTERWORTH * warped + square) * scale)


class Saturation(Artefact):
    """`<simkit:saturation>` of an IMU: largest magnitude of each axis, which larger values have after the noise.

    Args:
        params: the element: `angular_velocity` [rad/s] and `linear_acceleration` [m/s²], 0 for no limit.
        sensor: the IMU.
    """

    elements = ("imu/saturation",)
    order = 10.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        limits = [params.number(name, 0.0, minimum=0.0) or math.inf for name in QUANTITIES]
        self.limits = [limit for limit in limits for _ in range(3)]

    def apply(self, reading: ImuReading, truth: ImuReading, index: int) -> ImuReading:
        pairs = zip(reading.motion, self.limits, strict=True)
        return ImuReading(reading.orientation, [max(-limit, min(value, limit)) for value, limit in pairs])
