"""Values of an array that hold for a while."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
import numpy.typing as npt


@contextmanager
def temporary_values(
    array: npt.NDArray[np.generic], places: Sequence[int] | npt.NDArray[np.integer], values: Any
) -> Iterator[None]:
    """While it lasts, an array has these values in these places; then it has its own again."""
    places = np.asarray(places, dtype=np.intp)
    kept = array[places]
    array[places] = values
    try:
        yield
    finally:
        array[places] = kept
