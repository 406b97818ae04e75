"""Tone curve of 8-bit colours: sRGB (IEC 61966-2-1), from and to linear light, by tables.

Light is proportional to the radiance of a pixel; 65535 is white. Every 8-bit value has its own light, so that
`encode(LIGHT[colours])` returns the colours unchanged.
"""

from __future__ import annotations

import functools
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import power

WHITE: Final = 65535
"""Light of white."""

_LINEAR_END = 0.04045  # value below which the curve is a line
_SLOPE = 12.92

Bytes = npt.NDArray[np.uint8]
Light = npt.NDArray[np.uint16]


def to_light(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the light, 1 for white, of colour values from 0 to 1."""
    return np.where(values <= _LINEAR_END, values / _SLOPE, power((values + 0.055) / 1.055, 2.4))


@functools.cache
def light_table() -> Light:
    """Return the light of each 8-bit value, shape (256,)."""
    return np.rint(to_light(np.arange(256.0) / 255.0) * WHITE).astype(np.uint16)


@functools.cache
def colour_table() -> Bytes:
    """Return the nearest 8-bit value of each light, shape (65536,)."""
    limits = to_light((np.arange(255.0) + 0.5) / 255.0) * WHITE
    return np.searchsorted(limits, np.arange(WHITE + 1.0)).astype(np.uint8)
