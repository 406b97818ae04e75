"""Fog that grows with the depth, as in OpenGL."""

from __future__ import annotations

import functools
import math
from typing import Final

import numpy as np

from simkit.scene.world import Fog
from simkit.sensors.cameras.rendering.software.frame import Frame, reciprocals_of
from simkit.sensors.cameras.rendering.software.vectors import Floats

_MOST: Final = 16.0  # largest exponent in the table; exp(-16) is below one step of a colour
_STEPS: Final = 4096


def add_fog(fog: Fog, frame: Frame, image: Floats, keys: Floats) -> None:
    """Mix the colours of drawn pixels with the fog, in place; pixels without a shape have no fog."""
    pixels = np.flatnonzero(keys.ravel() < frame.far_key)
    if not len(pixels):
        return
    depths = (1.0 / reciprocals_of(keys.ravel()[pixels])).astype(np.float32)
    if fog.type == "linear":
        end = max(fog.end, fog.start + 1e-3)
        clear = np.clip((np.float32(end) - depths) / np.float32(end - fog.start), 0.0, 1.0)
    else:
        power = np.float32(fog.density) * depths
        clear = _decay(power * power if fog.type == "exp2" else power)
    flat = image.reshape(-1, 3)
    colour = np.array(fog.colour[:3], np.float32)
    seen = np.minimum(flat[pixels], np.float32(1.0))
    flat[pixels] = colour + clear[:, None] * (seen - colour)


def _decay(exponents: Floats) -> Floats:
    """Return exp(-x) from a table with linear interpolation, because NumPy's has other bits on other processors."""
    table = _decay_table()
    place = np.minimum(np.maximum(exponents, np.float32(0.0)), np.float32(_MOST)) * np.float32(_STEPS / _MOST)
    step = np.minimum(place.astype(np.int32), _STEPS - 1)
    low = table.take(step)
    found: Floats = low + (place - step.astype(np.float32)) * (table.take(step + 1) - low)
    return found


@functools.cache
def _decay_table() -> Floats:
    return np.array([math.exp(-_MOST * step / _STEPS) for step in range(_STEPS + 1)], np.float32)
