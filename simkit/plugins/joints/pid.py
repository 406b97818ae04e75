"""The controller that gz's joint systems share."""

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
"""Element of gz's joint systems -> attribute of `Pid`, in its order."""

_EFFORT: Final = "N·m or N"


class PidOptions(Options):
    """The numbers of a PID that gives an effort, as live parameters."""

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
        description="upper bound of the integral's part of the effort [N·m or N]; no bound where it is below i_min",
    )
    i_min: float = number(
        -1.0, _EFFORT, is_live=True, description="lower bound of the integral's part of the effort [N·m or N]"
    )
    cmd_max: float = number(
        1000.0,
        _EFFORT,
        is_live=True,
        description="upper bound of the effort [N·m or N]; no bound where it is below cmd_min",
    )
    cmd_min: float = number(-1000.0, _EFFORT, is_live=True, description="lower bound of the effort [N·m or N]")
    cmd_offset: float = number(0.0, _EFFORT, is_live=True, description="added to the effort [N·m or N]")


@dataclass(slots=True)
class Pid:
    """gz-math's PID of an error measured − wanted: offset − p − i − d.

    Attributes:
        i_max, i_min: bounds of the integral's part of the output; none where i_max < i_min.
        command_max, command_min: of the output; none where the first is below the second.
        integral: that part now.
        last: the error before; 0 at the start, so that the first call has a derivative.
        command: the last output.
        swings: how the error has swung about zero.
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
        """Of the numbers by the names of their elements: `p_gain` and so on."""
        return cls(*(numbers[name] for name in FIELDS))

    def update(self, error: float, step: float) -> float:
        """The output for an error now, `step` [s] after the last."""
        if step <= 0.0 or not math.isfinite(error):
            return 0.0
        self.integral = _within(self.integral + self.i * step * error, self.i_min, self.i_max)
        slope = (error - self.last) / step
        self.last = error
        wanted = self.offset - self.p * error - self.integral - self.d * slope
        self.command = _within(wanted, self.command_min, self.command_max)
        self.swings.see(error, self.command != wanted)
        return self.command

    def restart(self) -> None:
        """Forgets what was: as before the first call."""
        self.integral = self.last = self.command = 0.0
        self.swings = DivergenceDetector()


@dataclass(slots=True)
class DivergenceDetector:
    """Tells a loop that runs away from one that settles, by the peaks between two zeros of its error.

    Each of `GROWING` peaks in a row higher by `GROWTH` than the last one on the same side, or `SATURATED` in a row at
    the bounds of the output without getting smaller: such a loop is unstable, and only its bounds hold it. Peaks below
    `SMALL` [rad, m, rad/s or m/s] are noise.

    Attributes:
        last: the error before.
        peak: the highest error since the last zero.
        before, earlier: those of the two swings before.
        is_saturated: whether the output was at a bound since the last zero.
        grown: peaks in a row that grew.
        held: peaks in a row at the bounds that did not get smaller.
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
        """Takes note of an error, and of whether the output was at a bound."""
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
    def runs_away(self) -> bool:
        """Whether the loop is unstable."""
        return self.grown >= self.GROWING or self.held >= self.SATURATED


def declare_pid(
    plugin: Plugin, first: Pid, find: Callable[[], Pid], prefix: str = "", elements: Mapping[str, str] | None = None
) -> Pid:
    """Makes the numbers of a controller live parameters of its plugin: `p_gain`, `i_gain`, …, `cmd_offset`.

    Args:
        plugin: whose parameters they are.
        first: the controller with its default or first numbers; given back with those of the file.
        find: gives the controller as it is at the moment of a change (a restored one is another object).
        prefix: before each name.
        elements: parameter -> element that holds its first value; of the same name unless given.
    """
    for name, attribute in FIELDS.items():

        def take(value: float, attribute: str = attribute) -> None:
            setattr(find(), attribute, value)

        parameter = plugin.declare(
            prefix + name,
            float(getattr(first, attribute)),
            description=PidOptions.fields()[name].description,
            element=(elements or {}).get(name, prefix + name),
            on_change=take,
        )
        setattr(first, attribute, parameter.value)
    return first


def _within(value: float, low: float, high: float) -> float:
    return min(high, max(low, value)) if high >= low else value
