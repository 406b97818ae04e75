"""Arrays that are used again."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import numpy.typing as npt

_MOST = 6


class Spares:
    """Arrays of one shape, each used again once nobody holds it or a view of it any more.

    A picture's worth of fresh memory costs as much as what is written into it: the system hands it out page by page.
    Whoever keeps a picture keeps its array from being used again, for as long as it likes.

    Args:
        shape, dtype: of the arrays.
    """

    def __init__(self, shape: tuple[int, ...], dtype: npt.DTypeLike) -> None:
        self._shape, self._dtype = shape, dtype
        self._arrays: list[npt.NDArray[Any]] = [np.empty(shape, dtype)]
        self._idle = self._holders(0)

    def take(self) -> npt.NDArray[Any]:
        """An array that nobody else uses, with anything in it."""
        for i in range(len(self._arrays)):
            if self._holders(i) <= self._idle:
                return self._arrays[i]
        array = np.empty(self._shape, self._dtype)
        if len(self._arrays) < _MOST:
            self._arrays.append(array)
        return array

    def _holders(self, i: int) -> int:
        # views count: each holds the array that owns its memory
        return sys.getrefcount(self._arrays[i])
