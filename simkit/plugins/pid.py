"""The controller that gz's joint systems share."""

from __future__ import annotations

import math
from dataclasses import dataclass

from simkit.params import Params


@dataclass(slots=True)
class Pid:
    """gz-math's PID of an error measured − wanted: offset − p − i − d.

    Attributes:
        i_max, i_min: bounds of the integral's part of the output; none where i_max < i_min.
        command_max, command_min: of the output; none where the first is below the second.
        integral: that part now.
        last: the error before; 0 at the start, so that the first call has a derivative.
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

    @classmethod
    def from_params(cls, params: Params, p: float, i: float, d: float) -> Pid:
        """`<p_gain>` and the like, with the system's defaults."""
        return cls(
            p=params.number("p_gain", p),
            i=params.number("i_gain", i),
            d=params.number("d_gain", d),
            i_max=params.number("i_max", 1.0),
            i_min=params.number("i_min", -1.0),
            command_max=params.number("cmd_max", 1000.0),
            command_min=params.number("cmd_min", -1000.0),
            offset=params.number("cmd_offset", 0.0),
        )

    def update(self, error: float, step: float) -> float:
        """The output for an error now, `step` [s] after the last."""
        if step <= 0.0 or not math.isfinite(error):
            return 0.0
        self.integral = _within(self.integral + self.i * step * error, self.i_min, self.i_max)
        slope = (error - self.last) / step
        self.last = error
        return _within(
            self.offset - self.p * error - self.integral - self.d * slope, self.command_min, self.command_max
        )


def _within(value: float, low: float, high: float) -> float:
    return min(high, max(low, value)) if high >= low else value
