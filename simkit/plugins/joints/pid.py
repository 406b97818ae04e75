"""PID controller of Gazebo's joint systems."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from simkit.plugins.options import Options, number

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin

FIELDS: Final[Mapping[str, str]] = {
    "p_gain": "p",
    "i_gain": "i",
    "d_gain": "d",
    "i_max": "i_max",
    "i_min": "i_min",
    "cmd_max": "command_max",
    "cmd_min": "command_min",
    "cmd_offset": "offset",
}
"""Element name in Gazebo's joint systems -> attribute of `Pid`, in the order of its attributes."""

_EFFORT: Final = "N·m or N"


class PidOptions(Options):
    """Options of a PID whose output is an effort; all are live parameters."""

    p_gain: float = number(1.0, _EFFORT, is_live=True, description="proportional gain: effort [N·m or N] per error")
    i_gain: float = number(
        0.0, _EFFORT, is_live=True, description="integral gain: effort [N·m or N] per error and second"
    )
    d_gain: float = number(
        0.0, _EFFORT, is_live=True, description="derivative gain: effort [N·m or N] per error's rate"
    )
    i_max: float = number(
        1.0,
        _EFFORT,
        is_live=True,
        description="upper bound of the integral's part of the effort [N·m or N]; no bound if it is below i_min",
    )
    i_min: float = number(
        -1.0, _EFFORT, is_live=True, description="lower bound of the integral's part of the effort [N·m or N]"
    )
    cmd_max: float = number(
        1000.0,
        _EFFORT,
        is_live=True,
        description="upper bound of the effort [N·m or N]; no bound if it is below cmd_min",
    )
    cmd_min: float = number(-1000.0, _EFFORT, is_live=True, description="lower bound of the effort [N·m or N]")
    cmd_offset: float = number(0.0, _EFFORT, is_live=True, description="added to the effort [N·m or N]")


@dataclass(slots=True)
class Pid:
    """PID controller of gz-math: output = offset − p − i − d, for the error measured − commanded.

    Attributes:
        p, i, d: Gains.
        i_max, i_min: Limits of the integral term; no limit if i_max < i_min.
        command_max, command_min: Limits of the output; no limit if command_max < command_min.
        offset: Constant part of the output.
        integral: Current integral term.
        last: Error of the last call; 0 at the start, so that the first call has a derivative.
        command: Last output.
        swings: Detector of an unstable control loop.
    """

    p: float
    i: float
    d: float
    i_max: float
    i_min: float
    command_max: float
    command_min: float
    offset: float = 0.0
    integral: float = 0.0
    last: float = 0.0
    command: float = 0.0
    swings: DivergenceDetector = field(init=False, default_factory=lambda: DivergenceDetector())

    @classmethod
    def of(cls, numbers: Mapping[str, float]) -> Pid:
        """Create a controller from numbers by element name, such as `p_gain`."""
        return cls(*(numbers[name] for name in FIELDS))

    def update(self, error: float, step: float) -> float:
        """Return the output for an error.

        Args:
            error: Measured minus commanded value.
            step: Time since the last call [s].
        """
        if step <= 0.0 or not math.isfinite(error):
            return 0.0
        rate = (error - self.last) / step
        self.last = error
        unlimited = self.advance(error, rate, step)
        self.swings.see(error, self.command != unlimited)
        return self.command

    def advance(self, error: float, rate: float, step: float) -> float:
        """Advance the integral term, set `command`, and return the command without its limits.

        Args:
            error: Measured minus commanded value.
            rate: Rate of the error [1/s].
            step: Time since the last call [s].
        """
        self.integral = _within(self.integral + self.i * step * error, self.i_min, self.i_max)
        unlimited = self.offset - self.p * error - self.integral - self.d * rate
        self.command = _within(unlimited, self.command_min, self.command_max)
        return unlimited

    def restart(self) -> None:
        """Clear the state, as before the first call."""
        self.integral = self.last = self.command = 0.0
        self.swings = DivergenceDetector()


@dataclass(slots=True)
class DivergenceDetector:
    """Detector of an unstable control loop, based on the peaks of the error between its zero crossings.

    A loop is unstable after `GROWING` consecutive peaks, each at least `GROWTH` times the last peak on the same side. A
    loop is also unstable after `SATURATED` consecutive peaks that do not get smaller while the output is limited. Peaks
    below `SMALL` [rad, m, rad/s or m/s] count as noise.

    Attributes:
        last: Last error that is not zero.
        peak: Highest error since the last zero crossing.
        before, earlier: The last peak, and the peak before the last peak.
        is_saturated: True if the output was limited since the last zero crossing.
        grown: Number of consecutive peaks that grew.
        held: Number of consecutive peaks with a limited output that did not get smaller.
    """

    GROWING = 12
    SATURATED = 12
    GROWTH = 1.04
    SHRINKING = 0.98
    SMALL = 1e-3

    last: float = 0.0
    peak: float = 0.0
    before: float = 0.0
    earlier: float = 0.0
    is_saturated: bool = False
    grown: int = 0
    held: int = 0

    def see(self, error: float, is_saturated: bool) -> None:
        """Update the detector by one control step.

        Args:
            error: Error of the step.
            is_saturated: True if the output was limited.
        """
        if error * self.last < 0.0:
            has_grown = self.peak > self.GROWTH * self.earlier > 0.0 and self.peak > self.SMALL
            is_held = self.is_saturated and self.peak >= self.SHRINKING * self.earlier
            self.grown = self.grown + 1 if has_grown else 0
            self.held = self.held + 1 if is_held else 0
            self.earlier, self.before, self.peak, self.is_saturated = self.before, self.peak, 0.0, False
        if error != 0.0:
            self.last = error
        self.peak = max(self.peak, abs(error))
        self.is_saturated = self.is_saturated or is_saturated

    @property
    def is_unstable(self) -> bool:
        """True if the loop is unstable."""
        return self.grown >= self.GROWING or self.held >= self.SATURATED


def declare_pid(
    plugin: Plugin, first: Pid, find: Callable[[], Pid], prefix: str = "", elements: Mapping[str, str] | None = None
) -> Pid:
    """Declare the numbers of a controller as live parameters of its plugin: `p_gain`, `i_gain`, …, `cmd_offset`.

    Args:
        plugin: Plugin with the parameters.
        first: Controller with the default numbers.
        find: Callback that returns the current controller when a parameter changes; a restored snapshot has a new
            object.
        prefix: Prefix of each parameter name.
        elements: Name of the element with the first value, by parameter name; by default both names are the same.

    Returns:
        The controller `first`, with the numbers from the file.
    """
    for name, attribute in FIELDS.items():

        def set_number(value: float, attribute: str = attribute) -> None:
            setattr(find(), attribute, value)

        parameter = plugin.declare(
            prefix + name,
            float(getattr(first, attribute)),
            description=PidOptions.fields()[name].description,
            element=(elements or {}).get(name, prefix + name),
            on_change=set_number,
        )
        setattr(first, attribute, parameter.value)
    return first


def _within(value: float, low: float, high: float) -> float:
    return min(high, max(low, value)) if high >= low else value
