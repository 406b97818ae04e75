"""Temporary replacement of values in an array."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import numpy.typing as npt


@contextmanager
def temporary_values(
    array: npt.NDArray[np.generic], indices: Sequence[int] | npt.NDArray[np.integer], values: npt.ArrayLike
) -> Iterator[None]:
    """Set values of an array at these indices, inside the `with` block; restore the old values at its end."""
    indices = np.asarray(indices, dtype=np.intp)
    old_values = array[indices]
    array[indices] = values
    try:
        yield
    finally:
        array[indices] = old_values
