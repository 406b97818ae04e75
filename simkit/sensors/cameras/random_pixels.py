"""Random numbers for the pixels of images: a random word of 16 bits per value selects a value of a table."""

from __future__ import annotations

import functools
from collections.abc import Callable
from statistics import NormalDist

import numpy as np
import numpy.typing as npt

from simkit.runtime.engine.random_streams import RandomStream

Words = npt.NDArray[np.uint16]

_WORDS = 1 << 16


@functools.cache
def normal_table() -> npt.NDArray[np.float64]:
    """Return the standard normal's value in the middle of each of 65536 equally likely slices, scaled to variance 1."""
    upper = [NormalDist().inv_cdf((i + 0.5) / _WORDS) for i in range(_WORDS // 2, _WORDS)]
    table = np.concatenate((-np.array(upper[::-1]), upper))
    table /= table.std()
    return table


@functools.cache
def _looks_up_words() -> bool:
    import cv2

    return int(cv2.__version__.split(".")[0]) >= 5


def look_up(table: npt.NDArray[np.generic], words: Words, out: npt.NDArray[np.generic]) -> None:
    """Set `out[...] = table[words]`; OpenCV 5 and newer are three times as fast as NumPy."""
    if _looks_up_words():
        import cv2

        cv2.LUT(words, table, out)
    else:
        np.take(table, words, out=out, mode="wrap")


def word_source(stream: RandomStream, index: int) -> Callable[[int], Words]:
    """Return a function that returns the next random words of an image, shape (count,), for a given count.

    Args:
        stream: stream of the sensor; earlier images have no influence on the words.
        index: number of the sample.
    """
    key = stream.generator(index).bit_generator
    # a generator per image; SFC64 is the fastest for many numbers
    bits = np.random.SFC64(np.random.SeedSequence(key.random_raw(2).tolist()))
    return lambda count: bits.random_raw(-(-count // 4)).view(np.uint16)[:count]
