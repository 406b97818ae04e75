"""Memory for images: arrays that are used again, and strips of rows that stay in the processor's cache."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.array_pool import AnyArray, ArrayPool

_PIXELS = 1 << 14  # number of pixels processed at once
_pools: dict[tuple[tuple[int, ...], np.dtype[np.generic]], ArrayPool] = {}


def new_image(shape: tuple[int, int], dtype: npt.DTypeLike) -> AnyArray:
    """Return an image with undefined content, in memory of an image that nobody has any more where there is one."""
    key = shape, np.dtype(dtype)
    if key not in _pools:
        _pools[key] = ArrayPool(*key)
    return _pools[key].take()


def strips(shape: tuple[int, int]) -> Iterator[slice]:
    """Yield the rows of an image, a few at a time, a multiple of four because random words come in fours."""
    rows = max(4, _PIXELS // shape[1] // 4 * 4)
    for first in range(0, shape[0], rows):
        yield slice(first, min(first + rows, shape[0]))
