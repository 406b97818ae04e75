"""Random images with the same bits on every processor: correlated from pixel to pixel and from sample to sample.

The sums over windows are sums of integers, so their order does not matter.
"""

from __future__ import annotations

import functools
import math

import cv2
import numpy as np
import numpy.typing as npt

from simkit.runtime.engine.random_streams import RandomStream
from simkit.sensors.cameras.random_pixels import normal_table

Floats = npt.NDArray[np.float32]
_UNIT = 4096.0  # integer that stands for one standard deviation
LARGEST_WINDOW = 101  # [px] the sums of a window stay far below 2^31


Key = tuple[int, ...]


def random_key(stream: RandomStream, index: int) -> Key:
    """Return the seed of the numbers of one image, which depends on the stream and the index only."""
    return tuple(stream.generator(index).bit_generator.random_raw(2).tolist())


def random_words(key: Key, shape: tuple[int, int]) -> npt.NDArray[np.uint16]:
    """Return uniform numbers of 16 bits for the pixels of one image."""
    bits = np.random.SFC64(np.random.SeedSequence(key))  # the fastest generator for many numbers
    count = shape[0] * shape[1]
    return bits.random_raw(-(-count // 4)).view(np.uint16)[:count].reshape(shape)


@functools.cache
def _integer_normals() -> npt.NDArray[np.int16]:
    """Table from a random word to a normal number in steps of 1/4096."""
    return np.rint(normal_table() * _UNIT).astype(np.int16)


class NormalImages:
    """Images of standard normal numbers.

    Args:
        stream: random numbers.
        window: side of the square window [px] whose mean each pixel is; 1 for independent pixels. The correlation of
            two pixels is the share of their windows that overlaps.
        samples: number of samples after which an image has little in common with the present one; 0 for independent
            images. Between two independent images the numbers are cos(a)·first + sin(a)·second, with a from 0 to π/2.
    """

    def __init__(self, stream: RandomStream, window: int = 1, samples: float = 0.0) -> None:
        self._stream, self._window, self._samples = stream, window, samples
        self._drawn: dict[int, tuple[Key, Floats]] = {}  # by number, as several samples use an image

    def image(self, index: int, shape: tuple[int, int]) -> Floats:
        """Return the numbers of sample `index`; the array must not be modified."""
        if self._samples <= 1.0:
            return self._draw(random_key(self._stream, index), shape)
        first, part = divmod(index / self._samples, 1.0)
        angle = part * math.pi / 2
        before, after = self._kept(int(first), shape), self._kept(int(first) + 1, shape)
        image = before * np.float32(math.cos(angle))
        image += after * np.float32(math.sin(angle))
        return image

    def _kept(self, number: int, shape: tuple[int, int]) -> Floats:
        """Return an independent image, drawn if it is not kept; a new seed of the run changes the key."""
        key = random_key(self._stream, number)
        kept = self._drawn.get(number)
        if kept is not None and kept[0] == key and kept[1].shape == shape:
            return kept[1]
        image = self._draw(key, shape)
        self._drawn = {n: drawn for n, drawn in self._drawn.items() if abs(n - number) == 1} | {number: (key, image)}
        return image

    def _draw(self, key: Key, shape: tuple[int, int]) -> Floats:
        """Draw an independent image."""
        window = self._window
        padded = shape[0] + window - 1, shape[1] + window - 1
        words = random_words(key, padded)
        normals = np.take(_integer_normals(), words)
        if window > 1:
            sums = cv2.boxFilter(normals, cv2.CV_32S, (window, window), anchor=(0, 0), normalize=False)
            normals = sums[: shape[0], : shape[1]]
        image = normals.astype(np.float32)
        image *= np.float32(1.0 / (_UNIT * window))
        return image


@functools.cache
def _thresholds() -> Floats:
    """Table from a probability in steps of 1/65536 to the normal number below which this share lies."""
    table = np.empty(65537, np.float32)
    table[1:65536] = (normal_table()[:-1] + normal_table()[1:]) / 2
    table[0], table[65536] = -np.inf, np.inf
    return table


def threshold(probabilities: Floats) -> Floats:
    """Return the normal numbers below which the given shares of normal numbers lie."""
    found: Floats = np.take(_thresholds(), np.rint(probabilities * np.float32(65536.0)).astype(np.int32))
    return found


def window_sums(image: npt.NDArray[np.int64], radius: int) -> npt.NDArray[np.int64]:
    """Return the sums over squares of 2·radius + 1 pixels; beyond the edge, pixels repeat."""
    sums = np.pad(image, radius, mode="edge")
    side = 2 * radius + 1
    for axis in (0, 1):
        sums = np.cumsum(sums, axis=axis)
        sums = np.concatenate((np.zeros_like(np.take(sums, [0], axis)), sums), axis=axis)
        size = sums.shape[axis]
        sums = np.take(sums, range(side, size), axis) - np.take(sums, range(size - side), axis)
    return sums
