"""Wind of a world as a function of time, by Gazebo's model: rise time, sine variation and noise."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.extend import LARGEST, Options, block, number, text, without_effect

if TYPE_CHECKING:
    from simkit.extend import Vector

Velocity = tuple[float, float, float]
_FULL_TURN = 360.0  # degrees


@dataclass(frozen=True, slots=True)
class WindNoise:
    """White noise of a `<noise>` block, in the unit of the value to which the noise is added.

    Attributes:
        mean, stddev: Mean and standard deviation of the noise.
        bias_mean, bias_stddev: Mean and standard deviation of a constant bias.
        precision: The value is rounded to a multiple of this number; 0 for no rounding.
    """

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    precision: float = 0.0

    def on(self, value: float, draw: Callable[[], float], bias: Callable[[], float]) -> float:
        """Return the value with noise.

        Args:
            value: Value without noise.
            draw: Function that returns a standard normal number; not called for a zero `stddev`.
            bias: Function that returns the standard normal number of the bias; not called for a zero `bias_stddev`.
        """
        value += self.mean + self.bias_mean
        if self.bias_stddev > 0:
            value += self.bias_stddev * bias()
        if self.stddev > 0:
            value += self.stddev * draw()
        return round(value / self.precision) * self.precision if self.precision > 0 else value


@dataclass(frozen=True, slots=True)
class WindResponse:
    """First-order filter, sine and noise of the wind's strength, heading or vertical speed.

    Attributes:
        rise: Time constant of the filter [s].
        swing: Amplitude of the sine: a fraction of the strength, or an angle [degrees] for the heading.
        period: Period of the sine [s].
        flutter: Noise; None for no noise.
    """

    rise: float = 1.0
    swing: float = 0.0
    period: float = 1.0
    flutter: WindNoise | None = None

    def follow(self, mean: float, target: float, updates: int, step: float) -> float:
        """Return the value of the filter after some updates.

        Args:
            mean: Value before the updates.
            target: Value that the filter approaches; one update reaches it if the time constant is below `step`.
            updates: Number of updates.
            step: Time between updates [s].
        """
        left = 1.0 - min(step / self.rise, 1.0)
        return target + (mean - target) * left**updates

    def swings(self, time: float) -> float:
        """Return the value of the sine at a time [s], in the unit of `swing`."""
        return self.swing * math.sin(2 * math.pi * time / self.period) if self.swing else 0.0


@dataclass(frozen=True, slots=True)
class WindTarget:
    """Commanded wind, and the values of the filters at the tick of the command.

    Attributes:
        velocity: Commanded velocity [m/s], world frame.
        blows: True while the wind is on. While the wind is off, the filters keep their values.
        tick: Tick of the command.
        strength, rising: Filtered horizontal and vertical speeds [m/s] at that tick.
        heading: Filtered heading [degrees] at that tick; None before the first update.
    """

    velocity: Velocity
    blows: bool = True
    tick: int = 0
    strength: float = 0.0
    rising: float = 0.0
    heading: float | None = None


@dataclass(frozen=True, slots=True)
class Gusts:
    """Model of a world's wind as a function of time.

    Attributes:
        strength, heading, rising: Filters of horizontal speed, horizontal direction and vertical speed.
        step: Physics step [s].
    """

    strength: WindResponse
    heading: WindResponse
    rising: WindResponse
    step: float

    def start(self, velocity: Velocity) -> WindTarget:
        """Return the initial state: the wind is zero and approaches this velocity [m/s]."""
        return WindTarget(velocity)

    def means(self, target: WindTarget, tick: int) -> tuple[float, float, float]:
        """Return the filtered strength [m/s], heading [degrees] and vertical speed [m/s] in the step after a tick."""
        updates = tick - target.tick + 1 if target.blows else 0
        if updates <= 0:
            return target.strength, target.heading or 0.0, target.rising
        x, y, z = target.velocity
        heading = math.degrees(math.atan2(y, x))
        if target.heading is not None:  # turn in the shorter direction
            turn = math.remainder(heading - target.heading, _FULL_TURN)
            heading = self.heading.follow(target.heading, target.heading + turn, updates, self.step)
        return (
            self.strength.follow(target.strength, math.hypot(x, y), updates, self.step),
            heading,
            self.rising.follow(target.rising, z, updates, self.step),
        )

    def changed(self, target: WindTarget, velocity: Velocity, blows: bool, tick: int) -> WindTarget:
        """Return the state after a command.

        Args:
            target: State before the command.
            velocity: Commanded velocity [m/s], world frame.
            blows: True to switch the wind on, false to switch it off.
            tick: Tick of the command.
        """
        strength, heading, rising = self.means(target, tick - 1)
        has_begun = target.heading is not None or (target.blows and tick > target.tick)
        return WindTarget(velocity, blows, tick, strength, rising, heading if has_begun else None)

    def at(self, target: WindTarget, tick: int, draw: Callable[[str, int], Vector]) -> Velocity:
        """Return the velocity of the air [m/s] in the step after a tick; zero while the wind is off.

        Args:
            target: State after the last command.
            tick: Tick of the last command or any later tick.
            draw: Function that returns three standard normal numbers for a channel and an index.
        """
        if not target.blows:
            return 0.0, 0.0, 0.0
        strength, heading, rising = self.means(target, tick)
        time = (tick + 1) * self.step
        strength *= 1.0 + self.strength.swings(time)
        heading += self.heading.swings(time)

        def add_noise(response: WindResponse, value: float, index: int) -> float:
            if response.flutter is None:
                return value
            return response.flutter.on(
                value, lambda: float(draw("wind", tick)[index]), lambda: float(draw("wind bias", 0)[index])
            )

        strength = add_noise(self.strength, strength, 0)
        heading = math.radians(add_noise(self.heading, heading, 1))
        return strength * math.cos(heading), strength * math.sin(heading), add_noise(self.rising, rising, 2)


class WindNoiseOptions(Options):
    """Options of a `<noise>` block."""

    type_attribute: str = text(element="@type")
    type: str = text("none")
    dynamic_bias_stddev: bool = without_effect()
    dynamic_bias_correlation_time: bool = without_effect()
    mean: float = number(0.0, minimum=-LARGEST, maximum=LARGEST)
    stddev: float = number(0.0, minimum=0, maximum=LARGEST)
    bias_mean: float = number(0.0, minimum=-LARGEST, maximum=LARGEST)
    bias_stddev: float = number(0.0, minimum=0, maximum=LARGEST)
    precision: float = number(0.0, minimum=0, maximum=LARGEST)


class _SineOptions(Options):
    """Options shared by all `<sin>` blocks."""

    period: float = number(1.0, "s", minimum=1e-6)


class StrengthSineOptions(_SineOptions):
    """Options of the `<sin>` block of a strength."""

    amplitude_percent: float = number(0.0, minimum=-1e6, maximum=1e6)


class HeadingSineOptions(_SineOptions):
    """Options of the `<sin>` block of a heading."""

    amplitude: float = number(0.0, "deg", minimum=-1e6, maximum=1e6)


class VerticalWindOptions(Options):
    """Options of the `<vertical>` block."""

    time_for_rise: float = number(1.0, "s", minimum=1e-6)
    noise: WindNoiseOptions = block(WindNoiseOptions)


class WindStrengthOptions(VerticalWindOptions):
    """Options of the `<magnitude>` block."""

    sin: StrengthSineOptions = block(StrengthSineOptions)


class WindHeadingOptions(VerticalWindOptions):
    """Options of the `<direction>` block."""

    sin: HeadingSineOptions = block(HeadingSineOptions)


class HorizontalWindOptions(Options):
    """Options of the `<horizontal>` block."""

    magnitude: WindStrengthOptions = block(WindStrengthOptions)
    direction: WindHeadingOptions = block(WindHeadingOptions)


class GustOptions(Options):
    """Options of a wind that changes over time."""

    horizontal: HorizontalWindOptions = block(HorizontalWindOptions)
    vertical: VerticalWindOptions = block(VerticalWindOptions)


def read_gusts(options: GustOptions, step: float) -> Gusts:
    """Return the wind model that the `<horizontal>` and `<vertical>` blocks describe, and report invalid values."""
    strength, heading, vertical = options.horizontal.magnitude, options.horizontal.direction, options.vertical
    return Gusts(
        strength=WindResponse(
            strength.time_for_rise, strength.sin.amplitude_percent, strength.sin.period, _read_noise(strength.noise)
        ),
        heading=WindResponse(
            heading.time_for_rise, heading.sin.amplitude, heading.sin.period, _read_noise(heading.noise)
        ),
        rising=WindResponse(vertical.time_for_rise, 0.0, 1.0, _read_noise(vertical.noise)),
        step=step,
    )


def _read_noise(options: WindNoiseOptions) -> WindNoise | None:
    if not options.is_given:
        return None
    noise, kinds = options.params, ("gaussian", "gaussian_quantized", "none")
    kind = options.type_attribute or options.type
    if kind not in kinds:
        noise.error("SK-PARAM-002", f"found noise of type {kind!r}; expected {', '.join(kinds)}")
    if kind not in kinds[:2]:
        noise.mark_all_read()
        return None
    for name in ("dynamic_bias_stddev", "dynamic_bias_correlation_time"):
        if getattr(options, name):
            message = f"<{name}> has no effect on wind, as in Gazebo; use <time_for_rise> and <sin> for slow changes"
            noise.diagnostics.warning("SK-PLUGIN-111", message, noise.block(name).where)
    precision = options.precision if kind == kinds[1] else 0.0
    return WindNoise(options.mean, options.stddev, options.bias_mean, options.bias_stddev, precision)
