"""Wind of a world over time, by gz's model: it rises, turns, swells and has noise."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from simkit.params import LARGEST
from simkit.plugins.options import Options, block, number, text, without_effect

if TYPE_CHECKING:
    from simkit.pose import Vector

Velocity = tuple[float, float, float]
_BACK = 360.0  # degrees


@dataclass(frozen=True, slots=True)
class WindNoise:
    """White noise: `<noise>` with mean, stddev, bias_mean, bias_stddev and precision, in the unit of what it is on."""

    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    precision: float = 0.0

    def on(self, value: float, draw: Callable[[], float], bias: Callable[[], float]) -> float:
        """The value with it; nothing is drawn that has no deviation."""
        value += self.mean + self.bias_mean
        if self.bias_stddev > 0:
            value += self.bias_stddev * bias()
        if self.stddev > 0:
            value += self.stddev * draw()
        return round(value / self.precision) * self.precision if self.precision > 0 else value


@dataclass(frozen=True, slots=True)
class WindResponse:
    """How one of the three follows what is asked for.

    Attributes:
        rise: time constant [s].
        swing: of a sine; for strength a part of itself, for the heading degrees.
        period: of the sine [s].
        flutter: noise.
    """

    rise: float = 1.0
    swing: float = 0.0
    period: float = 1.0
    flutter: WindNoise | None = None

    def follow(self, mean: float, asked: float, updates: int, step: float) -> float:
        """Where the filter stands after some updates; one that rises within a step is there at once."""
        left = 1.0 - min(step / self.rise, 1.0)
        return asked + (mean - asked) * left**updates

    def swings(self, time: float) -> float:
        return self.swing * math.sin(2 * math.pi * time / self.period) if self.swing else 0.0


@dataclass(frozen=True, slots=True)
class WindTarget:
    """What is asked for, and where the filters stood when it was.

    Attributes:
        velocity: asked for [m/s], world frame.
        blows: whether the wind is on; off, the filters stand still.
        tick: since when.
        strength, rising: means over the ground and vertical [m/s].
        heading: mean [degrees]; None before the first update.
    """

    velocity: Velocity
    blows: bool = True
    tick: int = 0
    strength: float = 0.0
    rising: float = 0.0
    heading: float | None = None


@dataclass(frozen=True, slots=True)
class Gusts:
    """The wind of a world over time.

    Attributes:
        strength, heading, rising: over the ground, its direction, vertical.
        step: of the physics [s].
    """

    strength: WindResponse
    heading: WindResponse
    rising: WindResponse
    step: float

    def start(self, velocity: Velocity) -> WindTarget:
        """A calm, with a wind that is asked for."""
        return WindTarget(velocity)

    def means(self, seed: WindTarget, tick: int) -> tuple[float, float, float]:
        """Where the filters stand in the step that follows a tick: strength, heading [degrees], vertical speed."""
        updates = tick - seed.tick + 1 if seed.blows else 0
        if updates <= 0:
            return seed.strength, seed.heading or 0.0, seed.rising
        x, y, z = seed.velocity
        heading = math.degrees(math.atan2(y, x))
        if seed.heading is not None:  # the short way round
            turn = math.remainder(heading - seed.heading, _BACK)
            heading = self.heading.follow(seed.heading, seed.heading + turn, updates, self.step)
        return (
            self.strength.follow(seed.strength, math.hypot(x, y), updates, self.step),
            heading,
            self.rising.follow(seed.rising, z, updates, self.step),
        )

    def changed(self, seed: WindTarget, velocity: Velocity, blows: bool, tick: int) -> WindTarget:
        """What is asked for from a tick on."""
        strength, heading, rising = self.means(seed, tick - 1)
        has_begun = seed.heading is not None or (seed.blows and tick > seed.tick)
        return WindTarget(velocity, blows, tick, strength, rising, heading if has_begun else None)

    def at(self, seed: WindTarget, tick: int, draw: Callable[[str, int], Vector]) -> Velocity:
        """Velocity of the air [m/s] in the step that follows a tick; none while it is off.

        Args:
            seed: what is asked for.
            tick: any from the seed's on.
            draw: three standard normal numbers by channel and index.
        """
        if not seed.blows:
            return 0.0, 0.0, 0.0
        strength, heading, rising = self.means(seed, tick)
        time = (tick + 1) * self.step
        strength *= 1.0 + self.strength.swings(time)
        heading += self.heading.swings(time)

        def fluttered(course: WindResponse, value: float, index: int) -> float:
            if course.flutter is None:
                return value
            return course.flutter.on(
                value, lambda: float(draw("wind", tick)[index]), lambda: float(draw("wind bias", 0)[index])
            )

        strength = fluttered(self.strength, strength, 0)
        heading = math.radians(fluttered(self.heading, heading, 1))
        return strength * math.cos(heading), strength * math.sin(heading), fluttered(self.rising, rising, 2)


class WindNoiseOptions(Options):
    """A `<noise>` block."""

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
    """The period of a `<sin>` block."""

    period: float = number(1.0, "s", minimum=1e-6)


class StrengthSineOptions(_SineOptions):
    """The `<sin>` block of a strength."""

    amplitude_percent: float = number(0.0, minimum=-1e6, maximum=1e6)


class HeadingSineOptions(_SineOptions):
    """The `<sin>` block of a heading."""

    amplitude: float = number(0.0, "deg", minimum=-1e6, maximum=1e6)


class VerticalWindOptions(Options):
    """The `<vertical>` block."""

    time_for_rise: float = number(1.0, "s", minimum=1e-6)
    noise: WindNoiseOptions = block(WindNoiseOptions)


class WindStrengthOptions(VerticalWindOptions):
    """The `<magnitude>` block."""

    sin: StrengthSineOptions = block(StrengthSineOptions)


class WindHeadingOptions(VerticalWindOptions):
    """The `<direction>` block."""

    sin: HeadingSineOptions = block(HeadingSineOptions)


class HorizontalWindOptions(Options):
    """The `<horizontal>` block."""

    magnitude: WindStrengthOptions = block(WindStrengthOptions)
    direction: WindHeadingOptions = block(WindHeadingOptions)


class GustOptions(Options):
    """How a world's wind changes."""

    horizontal: HorizontalWindOptions = block(HorizontalWindOptions)
    vertical: VerticalWindOptions = block(VerticalWindOptions)


def read_gusts(options: GustOptions, step: float) -> Gusts:
    """The `<horizontal>` and `<vertical>` of a wind plugin; what is wrong is reported."""
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
        noise.error("SK-PARAM-002", f"found noise of type {kind!r}, allowed is {', '.join(kinds)}")
    if kind not in kinds[:2]:
        noise.mark_all_read()
        return None
    for name in ("dynamic_bias_stddev", "dynamic_bias_correlation_time"):
        if getattr(options, name):
            message = f"<{name}> has no effect on wind, in Gazebo neither; <time_for_rise> and <sin> make it slow"
            noise.diagnostics.warning("SK-PLUGIN-111", message, noise.block(name).where)
    precision = options.precision if kind == kinds[1] else 0.0
    return WindNoise(options.mean, options.stddev, options.bias_mean, options.bias_stddev, precision)
