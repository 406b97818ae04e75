"""Arrays that are used again once no message holds them."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

_MAX_ARRAYS = 6


# Array of bytes, whole numbers or floats.
AnyArray = npt.NDArray[Any]


class ArrayPool:
    """Arrays of one shape, each used again once nobody holds it or a view of it any more. Several threads may ask.

    A picture's worth of fresh memory costs as much as what is written into it: the system hands it out page by page.
    Whoever keeps a picture keeps its array from being used again, for as long as it likes.

    Args:
        shape, dtype: of the arrays.
        make: makes one of them; `np.zeros` for arrays that are not written to everywhere.
    """

    def __init__(self, shape: tuple[int, ...], dtype: npt.DTypeLike, make: Callable[..., AnyArray] = np.empty) -> None:
        self._shape, self._dtype, self._make = shape, dtype, make
        self._arrays: list[AnyArray] = [make(shape, dtype)]
        self._turn = threading.Lock()
        self._idle = self._holders(0)

    def take(self) -> AnyArray:
        """An array that nobody else uses, with anything in it."""
        with self._turn:  # until whoever asked holds it
            for i in range(len(self._arrays)):
                if self._holders(i) <= self._idle:
                    return self._arrays[i]
        array = self._make(self._shape, self._dtype)
        if len(self._arrays) < _MAX_ARRAYS:
            self._arrays.append(array)
        return array

    def _holders(self, i: int) -> int:
        # views count: each holds the array that owns its memory
        return sys.getrefcount(self._arrays[i])
