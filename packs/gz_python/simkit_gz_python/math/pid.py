"""PID controller and rolling mean of gz-math."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from copy import copy
from datetime import timedelta

from simkit.plugins.joints.pid import Pid
from simkit_gz_python.math.value_base import CppArgument


def _getter(attribute: str) -> Callable[[PID], float]:
    def read(self: PID) -> float:
        return float(getattr(self._loop, attribute))

    return read


def _setter(attribute: str) -> Callable[[PID, float], None]:
    def write(self: PID, value: float) -> None:
        setattr(self._loop, attribute, float(value))

    return write


class PID:
    """PID controller of gz-math: `cmd = offset − p·e − ∫i·e − d·e'` for the error e = measured − desired.

    The integral part and the output each have two bounds. A pair of bounds has no effect if the upper bound is below
    the lower bound.
    """

    _loop: Pid

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
            self._loop, (self._error, _, self._rate) = copy(_p._loop), _p.errors()
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
        self._loop = Pid(*map(float, (_p, _i, _d, _imax, _imin, _cmdMax, _cmdMin, _cmdOffset)))
        self._error = self._rate = 0.0

    def reset(self) -> None:
        """Set the errors and the command to 0."""
        self._loop.restart()
        self._error = self._rate = 0.0

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
            self._rate, self._loop.last = (error - self._loop.last) / dt, float(error)
        self._error = float(error)
        self._loop.advance(error, self._rate, dt)
        return self._loop.command

    p_gain, set_p_gain = _getter("p"), _setter("p")
    i_gain, set_i_gain = _getter("i"), _setter("i")
    d_gain, set_d_gain = _getter("d"), _setter("d")
    i_max, set_i_max = _getter("i_max"), _setter("i_max")
    i_min, set_i_min = _getter("i_min"), _setter("i_min")
    cmd_max, set_cmd_max = _getter("command_max"), _setter("command_max")
    cmd_min, set_cmd_min = _getter("command_min"), _setter("command_min")
    cmd_offset, set_cmd_offset = _getter("offset"), _setter("offset")
    cmd, set_cmd = _getter("command"), _setter("command")

    def errors(self) -> tuple[float, float, float]:
        """Return the error, the integral part of the command and the rate of the error."""
        return self._error, self._loop.integral, self._rate


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
