"""Errors of the sensors of hector_gazebo_plugins.

The error of each axis is offset + drift + white noise. The drift d is a first-order Gauss-Markov process with the
standard deviation `…Drift` and the correlation frequency `…DriftFrequency` f: between two instants with the distance
dt, d changes to d · exp(-f·dt), plus noise that keeps the standard deviation. It starts at zero. (The sources integrate
the same process by Euler's method, and add its noise once per step of any length, so that the drift depends on the
update rate.)
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params
from simkit.elementary_functions import exp
from simkit.extend import LARGEST, Vector

if TYPE_CHECKING:
    from simkit.runtime.engine.random_streams import RandomStream

_HOUR: Final = 3600.0  # [s]


class HectorError:
    """Error of a measurement with several axes.

    Args:
        params: parameters of the plugin.
        prefix: start of the names of the elements, such as `accel`; may be empty.
        size: number of axes.
        stream: random stream of 2 · `size` numbers.

    Attributes:
        noise: standard deviation of the white noise, shape (size,).
        drifts: true if the drift changes, so that every instant counts.
    """

    def __init__(self, params: Params, prefix: str, size: int, stream: RandomStream) -> None:
        self._stream, self._size = stream, size
        names = [f"{prefix}{name}" if prefix else name[0].lower() + name[1:] for name in _FIELDS]
        values = [_axes(params, name, size, default) for name, default in zip(names, _DEFAULTS, strict=True)]
        self._offset, self._deviation, self._frequency, self.noise = values
        self._drift = np.zeros(size)
        self.drifts = bool(self._deviation.any())

    @property
    def is_zero(self) -> bool:
        """True if the error is always zero."""
        return not (self.drifts or self._offset.any() or self.noise.any())

    def add_offset(self, values: Sequence[float]) -> None:
        """Set the offsets of axes for which the file gives none."""
        self._offset = np.where(self._offset == 0, values, self._offset)

    def advance(self, index: int, dt: float) -> Vector:
        """Return the error at the next instant.

        Args:
            index: number of the instant.
            dt: time since the last instant [s].
        """
        drawn = self._stream.normal(index)
        left = exp(-self._frequency * dt)
        self._drift = left * self._drift + self._deviation * np.sqrt(1 - left**2) * drawn[: self._size]
        error: Vector = self._offset + self._drift + self.noise * drawn[self._size :]
        return error

    def restart(self) -> None:
        """Set the drift to zero."""
        self._drift = np.zeros(self._size)


_FIELDS: Final = ("Offset", "Drift", "DriftFrequency", "GaussianNoise")
_DEFAULTS: Final = (0.0, 0.0, 1 / _HOUR, 0.0)


def _axes(params: Params, name: str, size: int, default: float) -> Vector:
    """Return the numbers of an element, one for each axis; a single number is that of all axes."""
    child = params.child(name)
    least = -LARGEST if name.lower().endswith("offset") else 0.0
    if size > 1 and child is not None and len(child.value.split()) == size:
        values = np.array(params.vector(name, size, (default,) * size))
        if values.min() < least:
            child.error("SK-PARAM-002", f"<{name}>: found {child.value!r}; expected numbers of at least 0")
        return values
    return np.full(size, params.number(name, default, minimum=least, maximum=LARGEST))
