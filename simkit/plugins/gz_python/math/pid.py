"""PID controller and rolling mean of gz-math."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from datetime import timedelta

from simkit.plugins.gz_python.math.value_base import CppArgument


def _getter(attribute: str) -> Callable[[PID], float]:
    def read(self: PID) -> float:
        return float(getattr(self, attribute))

    return read


def _setter(attribute: str) -> Callable[[PID, float], None]:
    def write(self: PID, value: float) -> None:
        setattr(self, attribute, float(value))

    return write


class PID:
    """PID controller of gz-math: `cmd = offset − p·e − ∫i·e − d·e'` for the error e = measured − desired.

    The integral part and the output each have two bounds. A pair of bounds has no effect if the upper bound is below
    the lower bound.
    """

    def __init__(
        self,
        _p: PID | float = 0.0,
        _i: float = 0.0,
        _d: float = 0.0,
        _imax: float = -1.0,
        _imin: float = 0.0,
        _cmdMax: float = -1.0,  # noqa: N803 - keyword names of gz-math's binding
        _cmdMin: float = 0.0,  # noqa: N803
        _cmdOffset: float = 0.0,  # noqa: N803
    ) -> None:
        if isinstance(_p, PID):
            vars(self).update(vars(_p))
        else:
            self.init(_p, _i, _d, _imax, _imin, _cmdMax, _cmdMin, _cmdOffset)

    def init(
        self,
        _p: float = 0.0,
        _i: float = 0.0,
        _d: float = 0.0,
        _imax: float = -1.0,
        _imin: float = 0.0,
        _cmdMax: float = -1.0,  # noqa: N803
        _cmdMin: float = 0.0,  # noqa: N803
        _cmdOffset: float = 0.0,  # noqa: N803
    ) -> None:
        """Set the gains and bounds, and reset the controller."""
        self._p, self._i, self._d = float(_p), float(_i), float(_d)
        self._i_max, self._i_min = float(_imax), float(_imin)
        self._cmd_max, self._cmd_min, self._offset = float(_cmdMax), float(_cmdMin), float(_cmdOffset)
        self.reset()

    def reset(self) -> None:
        """Set the errors and the command to 0."""
        self._last = self._error = self._integral = self._rate = self._cmd = 0.0

    def update(self, error: float, *rate_and_time: CppArgument) -> float:
        """Return the command for an error: `update(error, dt)` or `update(error, rate, dt)`.

        Args:
            error: measured − desired.
            rate_and_time: optional rate of change of the error [1/s], then the time since the last call (a `timedelta`
                or a number [s]).
        """
        *rates, elapsed = rate_and_time
        dt = elapsed.total_seconds() if isinstance(elapsed, timedelta) else float(elapsed)
        if dt == 0.0 or not all(map(math.isfinite, (error, *rates))):
            return 0.0
        if rates:
            self._rate = float(rates[0])
        else:
            self._rate, self._last = (error - self._last) / dt, float(error)
        self._error = float(error)
        self._integral = _clamp_if_ordered(self._integral + self._i * dt * error, self._i_min, self._i_max)
        command = self._offset - self._p * error - self._integral - self._d * self._rate
        self._cmd = _clamp_if_ordered(command, self._cmd_min, self._cmd_max)
        return self._cmd

    p_gain, set_p_gain = _getter("_p"), _setter("_p")
    i_gain, set_i_gain = _getter("_i"), _setter("_i")
    d_gain, set_d_gain = _getter("_d"), _setter("_d")
    i_max, set_i_max = _getter("_i_max"), _setter("_i_max")
    i_min, set_i_min = _getter("_i_min"), _setter("_i_min")
    cmd_max, set_cmd_max = _getter("_cmd_max"), _setter("_cmd_max")
    cmd_min, set_cmd_min = _getter("_cmd_min"), _setter("_cmd_min")
    cmd_offset, set_cmd_offset = _getter("_offset"), _setter("_offset")

    def cmd(self) -> float:
        """Return the last command."""
        return self._cmd

    def set_cmd(self, value: float) -> None:
        self._cmd = float(value)

    def errors(self) -> tuple[float, float, float]:
        """Return the error, the integral part of the command and the rate of the error."""
        return self._error, self._integral, self._rate


class RollingMean:
    """Mean of the last values, at most as many as the window size."""

    def __init__(self, window_size: int = 10) -> None:
        self._values: deque[float] = deque(maxlen=max(1, int(window_size)))

    def push(self, value: float) -> None:
        self._values.append(float(value))

    def mean(self) -> float:
        """Return the mean; NaN if there is no value."""
        return math.fsum(self._values) / len(self._values) if self._values else math.nan

    def count(self) -> int:
        return len(self._values)

    def clear(self) -> None:
        self._values.clear()

    def set_window_size(self, size: int) -> None:
        """Set the window size and remove all values, as gz-math does."""
        if size > 0:
            self._values = deque(maxlen=int(size))

    def window_size(self) -> int:
        return self._values.maxlen or 0


def _clamp_if_ordered(value: float, low: float, high: float) -> float:
    return min(high, max(low, value)) if high >= low else value
