"""Pool of arrays that are reused after their last message is gone."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

_MAX_ARRAYS = 6


# array of bytes, integers or floats
AnyArray = npt.NDArray[Any]


class ArrayPool:
    """Arrays of one shape, each reused once no other object refers to it or to a view of it. The class is thread-safe.

    Fresh memory for an image costs as much time as writing the image, because the system allocates it page by page. An
    array is not reused while a subscriber keeps its image.

    Args:
        shape, dtype: shape and type of the arrays.
        make: function that makes an array; use `np.zeros` for arrays that are not written to everywhere.
    """

    def __init__(self, shape: tuple[int, ...], dtype: npt.DTypeLike, make: Callable[..., AnyArray] = np.empty) -> None:
        self._shape, self._dtype, self._make = shape, dtype, make
        self._arrays: list[AnyArray] = [make(shape, dtype)]
        self._lock = threading.Lock()
        self._idle = self._count_references(0)

    def take(self) -> AnyArray:
        """Return an array without other references, with undefined content."""
        with self._lock:  # until the caller has a reference to the array
            for i in range(len(self._arrays)):
                if self._count_references(i) <= self._idle:
                    return self._arrays[i]
        array = self._make(self._shape, self._dtype)
        if len(self._arrays) < _MAX_ARRAYS:
            self._arrays.append(array)
        return array

    def _count_references(self, i: int) -> int:
        # views count too, because each refers to the array that owns its memory
        return sys.getrefcount(self._arrays[i])
