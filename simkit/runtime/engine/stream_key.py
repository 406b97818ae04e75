"""Key of a random stream for NumPy's generators."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numpy.random.bit_generator import ISeedSequence


class StreamKey(ISeedSequence):
    """Key of a stream in the form that NumPy's generators take.

    A generator that gets the key as a number draws another one from the operating system first, which takes longer than
    the samples of an IMU.
    """

    def __init__(self, seed: int, name: tuple[int, ...]) -> None:
        # NumPy splits numbers into the same words, but takes three times as long
        low, *higher = (seed >> shift & 0xFFFFFFFF for shift in range(0, max(1, seed.bit_length()), 32))
        words = np.array((low, *higher, *name), np.uint32)
        self._key = np.asarray(np.random.SeedSequence(words).generate_state(2, np.uint64), dtype=np.uint64)

    def generate_state(self, n_words: int, dtype: object = np.uint64) -> npt.NDArray[np.uint64]:
        """Return the key, two words; Philox asks for nothing else."""
        return self._key
