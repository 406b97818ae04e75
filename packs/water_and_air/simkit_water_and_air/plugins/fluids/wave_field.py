"""Waves of a sea as a sum of a few long-crested waves in deep water, by the model of VRX (Virtual RobotX).

A component with amplitude a, direction d and wavenumber k has the angular frequency ω = √(g·k), with g = 9.8 m/s². The
height of the surface above its mean level is

    η(x, y, t) = (1 - exp(-t/τ)) · Σ a·cos(k·(d·(x, y)) - ω·t)

`PMS` takes up to three components from the spectrum of Pierson and Moskowitz (1964) around the peak frequency; `CWR`
takes components of a constant ratio of wavelength and amplitude around the mean wave. Source: `Wavefield.cc` of VRX.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from simkit import ModelPlugin
from simkit.extend import Options, block, choice, number, text, without_effect
from simkit.float_sum import float_sum
from simkit.msgs import valid_topic

if TYPE_CHECKING:
    from simkit.msgs import ParameterValue, ParamVec

PARAMETERS: Final = "ros_gz_interfaces/msg/ParamVec"
_GRAVITY: Final = 9.8  # [m/s²], of the waves, independent of the world
_ALPHA, _BETA, _SPECTRUM_GRAVITY = 0.0081, 1.25, 9.81  # constants of the spectrum of Pierson and Moskowitz
_MOST_COMPONENTS: Final = {"PMS": 3, "CWR": 100}
_INTEGER, _DOUBLE, _TEXT, _DOUBLES = 2, 3, 4, 8  # of rcl_interfaces/msg/ParameterType
_MOST: Final = 1e4


@dataclass(frozen=True, slots=True)
class Wave:
    """Component of a wave field.

    Attributes:
        amplitude: Amplitude [m].
        wavenumber: Wavenumber [rad/m].
        frequency: Angular frequency [rad/s].
        x, y: Direction in which the wave travels; a unit vector.
    """

    amplitude: float
    wavenumber: float
    frequency: float
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class WaveParameters:
    """Parameters of a wave field, with the defaults of VRX.

    Attributes:
        model: `PMS` or `CWR`.
        number: Number of components.
        scale: Ratio of the frequencies (PMS) or wavelengths (CWR) of neighbouring components.
        angle: Angle between the directions of neighbouring components [rad].
        amplitude: Amplitude of the mean wave [m], only for CWR.
        period: Period of the mean wave or of the peak of the spectrum [s].
        direction: Direction of the mean wave; not zero, of any length.
        tau: Time constant with which the waves grow at the start [s].
        gain: Factor of the amplitudes, only for PMS.
    """

    model: str = "PMS"
    number: int = 3
    scale: float = 1.1
    angle: float = 0.4
    amplitude: float = 0.0
    period: float = 5.0
    direction: tuple[float, float] = (1.0, 0.0)
    tau: float = 2.0
    gain: float = 1.0

    def find_fault(self) -> str:
        """Return a description of the first invalid parameter; empty if all are valid."""
        if self.model not in _MOST_COMPONENTS:
            return f"the model {self.model!r} is unknown; expected PMS or CWR"
        bounds = {"number": (0, _MOST_COMPONENTS[self.model]), "scale": (1e-3, 1e3), "period": (1e-3, 1e6)}
        bounds |= {"tau": (0.0, 1e9), "gain": (-_MOST, _MOST), "amplitude": (-_MOST, _MOST), "angle": (-_MOST, _MOST)}
        for name, (low, high) in bounds.items():
            value = getattr(self, name)
            if not low <= value <= high:
                return f"{name} is {value:g}; expected {low:g} to {high:g} with the model {self.model}"
        if not 1e-9 < math.hypot(*self.direction) < math.inf:
            return f"the direction is {self.direction}; expected a horizontal vector that is not zero"
        return ""

    def waves(self) -> tuple[Wave, ...]:
        """Return the components."""
        mean = 2 * math.pi / self.period
        length = math.hypot(*self.direction)
        x, y = (value / length for value in self.direction)
        middle = self.number // 2 if self.model == "CWR" else 1
        waves = []
        for n in range(-middle, self.number - middle):
            factor = self.scale**n
            if self.model == "CWR":
                frequency, amplitude = mean / math.sqrt(factor), factor * self.amplitude
            else:
                frequency = mean * factor
                amplitude = self.gain * math.sqrt(2 * _spectrum(frequency, mean) * self._width(n) * mean)
            c, s = math.cos(n * self.angle), math.sin(n * self.angle)
            waves.append(Wave(amplitude, frequency**2 / _GRAVITY, frequency, c * x - s * y, s * x + c * y))
        return tuple(waves)

    def _width(self, n: int) -> float:
        """Return the width of the band of frequencies of a component of PMS, relative to the peak frequency."""
        scale = self.scale
        return abs((1 - 1 / scale, (scale - 1 / scale) / 2, scale - 1)[n + 1])


def _spectrum(frequency: float, peak: float) -> float:
    """Return the density of the spectrum of Pierson and Moskowitz [m²·s/rad] at an angular frequency [rad/s]."""
    return _ALPHA * _SPECTRUM_GRAVITY**2 / frequency**5 * math.exp(-_BETA * (peak / frequency) ** 4)


@dataclass(frozen=True, slots=True)
class WaveField:
    """Height of a sea's surface as a function of position and time.

    Attributes:
        waves: Components; empty for calm water.
        tau: Time constant with which the waves grow from t = 0 [s].
    """

    waves: tuple[Wave, ...] = ()
    tau: float = 0.0

    def height(self, x: float, y: float, time: float) -> float:
        """Return the height of the surface above its mean level [m] at a point of the plane."""
        total = float_sum(
            w.amplitude * math.cos(w.wavenumber * (w.x * x + w.y * y) - w.frequency * time) for w in self.waves
        )
        return total * self._growth(time)

    def vertical_velocity(self, x: float, y: float, time: float) -> float:
        """Return the vertical velocity of the water at the surface [m/s]."""
        rate = float_sum(
            w.amplitude * w.frequency * math.sin(w.wavenumber * (w.x * x + w.y * y) - w.frequency * time)
            for w in self.waves
        )
        return rate * self._growth(time)

    def _growth(self, time: float) -> float:
        return 1 - math.exp(-time / self.tau) if self.tau > 0 else 1.0


class WaveOptions(Options):
    """Options of the `<wave>` block."""

    model: str = choice(tuple(_MOST_COMPONENTS), "PMS")
    count: float = number(3, element="number", minimum=0, maximum=1000)
    scale: float = number(1.1, minimum=1e-3, maximum=1e3)
    angle: float = number(0.4, "rad", minimum=-_MOST, maximum=_MOST)
    amplitude: float = number(0.0, "m", minimum=-_MOST, maximum=_MOST)
    period: float = number(5.0, "s", minimum=1e-3, maximum=1e6)
    direction: str = text("1 0")  # a vector or, as in VRX, an angle [rad]
    tau: float = number(2.0, "s", minimum=0)
    gain: float = number(1.0, minimum=-_MOST, maximum=_MOST)
    # in VRX, the phase has no effect, and the steepness changes only pictures
    phase: bool = without_effect()
    steepness: bool = without_effect()

    def read(self) -> WaveParameters:
        """Return the parameters; a fault is reported as an error."""
        self.read_all()
        parameters = WaveParameters(
            model=self.model,
            number=int(self.count),
            scale=self.scale,
            angle=self.angle,
            amplitude=self.amplitude,
            period=self.period,
            direction=self._read_direction(),
            tau=self.tau,
            gain=self.gain,
        )
        if self.is_given and (fault := parameters.find_fault()):
            self.params.error("SK-PARAM-002", f"<wave>: {fault}")
            return WaveParameters()
        return parameters

    def _read_direction(self) -> tuple[float, float]:
        if len(self.direction.split()) == 1:
            return _direction_of(self.params.number("direction"))
        x, y = self.params.vector("direction", 2, (1.0, 0.0))
        return x, y


class WavefieldOptions(Options):
    """Options of the `<wavefield>` block."""

    topic: str = text("/wavefield/parameters")
    size: bool = without_effect()  # of the picture of the waves
    cell_count: bool = without_effect()
    wave: WaveOptions = block(WaveOptions)


class WavesBase(ModelPlugin):
    """Base class of plugins of a model in waves, which are set in the file or by messages on a topic."""

    _wave_parameters: WaveParameters
    _waves: WaveField

    def read_waves(self, options: WavefieldOptions) -> None:
        """Read the `<wavefield>` block; a subclass calls this method in `prepare`.

        Without the block, the water is calm until a message arrives.
        """
        options.read_all()
        self._wave_parameters = options.wave.read()
        self._waves = self._field() if options.is_given else WaveField()

    def listen_to_waves(self, options: WavefieldOptions) -> None:
        """Subscribe to the parameters of the waves; a subclass calls this method in `load`."""
        self.listen(valid_topic(options.topic), PARAMETERS, self._on_waves)

    def _field(self) -> WaveField:
        return WaveField(self._wave_parameters.waves(), self._wave_parameters.tau)

    def _on_waves(self, message: ParamVec) -> None:
        changes: dict[str, Any] = {}
        for parameter in message.params:
            value = _value_of(parameter.value)
            if parameter.name == "direction" and isinstance(value, tuple) and len(value) >= 2:
                changes["direction"] = value[:2]
            elif parameter.name == "direction" and isinstance(value, float):
                changes["direction"] = _direction_of(value)
            elif parameter.name == "model" and isinstance(value, str):
                changes["model"] = value
            elif parameter.name == "number" and isinstance(value, float):
                changes["number"] = int(value) if math.isfinite(value) else -1
            elif parameter.name in _NUMBERS and isinstance(value, float):
                changes[parameter.name] = value
            elif parameter.name not in _WITHOUT_EFFECT:
                what = f"parameter {parameter.name!r} of a wave field is unknown or has a wrong type"
                self._once.left_out(parameter.name, f"{what}; it is ignored")
        parameters = replace(self._wave_parameters, **changes)
        if fault := parameters.find_fault():
            self._once.left_out("waves", f"a message with parameters of a wave field is ignored: {fault}")
            return
        self._wave_parameters = parameters
        self._waves = self._field()


_NUMBERS: Final = frozenset(("scale", "angle", "amplitude", "period", "tau", "gain"))
_WITHOUT_EFFECT: Final = frozenset(("size", "cell_count", "phase", "steepness"))


def _direction_of(angle: float) -> tuple[float, float]:
    """Return the direction at an angle from the x axis [rad]; NaN for an angle that is NaN or infinite."""
    return (math.cos(angle), math.sin(angle)) if math.isfinite(angle) else (math.nan, math.nan)


def _value_of(value: ParameterValue) -> float | str | tuple[float, ...] | None:
    """Return the value of an `rcl_interfaces/msg/ParameterValue`; None for another type."""
    if value.type == _INTEGER:
        return float(value.integer_value)
    if value.type == _DOUBLE:
        return float(value.double_value)
    if value.type == _TEXT:
        return str(value.string_value)
    return tuple(map(float, value.double_array_value)) if value.type == _DOUBLES else None
