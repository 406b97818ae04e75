"""Random images with the same bits on every processor: correlated from pixel to pixel and from sample to sample.

The sums over windows are sums of integers, so their order does not matter.
"""

from __future__ import annotations

import functools
import math

import cv2
import numpy as np
import numpy.typing as npt

from simkit.extend import RandomStream
from simkit.sensors.cameras.random_pixels import look_up, normal_table, word_source
from simkit_realism.depth_images.image_buffers import new_image, strips

Floats = npt.NDArray[np.float32]
_UNIT = 4096.0  # integer that stands for one standard deviation
LARGEST_WINDOW = 101  # [px] the sums of a window stay far below 2^31


def random_words(stream: RandomStream, index: int, shape: tuple[int, int]) -> npt.NDArray[np.uint16]:
    """Return uniform numbers of 16 bits for the pixels of sample `index`."""
    words: npt.NDArray[np.uint16] = word_source(stream, index)(shape[0] * shape[1]).reshape(shape)
    return words


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
        self._drawn: dict[int, tuple[list[int], Floats]] = {}  # by number, as several samples use an image

    def image(self, index: int, shape: tuple[int, int]) -> Floats:
        """Return the numbers of sample `index`; the array must not be modified."""
        if self._samples <= 1.0:
            return self._draw(index, shape)
        first, part = divmod(index / self._samples, 1.0)
        angle = part * math.pi / 2
        before, after = self._kept(int(first), shape), self._kept(int(first) + 1, shape)
        image = new_image(shape, np.float32)
        np.multiply(before, np.float32(math.cos(angle)), out=image)
        for rows in strips(shape):
            image[rows] += after[rows] * np.float32(math.sin(angle))
        return image

    def _kept(self, number: int, shape: tuple[int, int]) -> Floats:
        """Return an independent image, drawn if it is not kept; a new seed of the run changes its first numbers."""
        key = self._stream.generator(number).bit_generator.random_raw(2).tolist()
        kept = self._drawn.get(number)
        if kept is not None and kept[0] == key and kept[1].shape == shape:
            return kept[1]
        image = self._draw(number, shape)
        self._drawn = {n: drawn for n, drawn in self._drawn.items() if abs(n - number) == 1} | {number: (key, image)}
        return image

    def _draw(self, number: int, shape: tuple[int, int]) -> Floats:
        """Draw an independent image."""
        window = self._window
        padded = shape[0] + window - 1, shape[1] + window - 1
        normals = new_image(padded, np.int16)
        next_words = word_source(self._stream, number)
        for rows in strips(padded):
            part = normals[rows]
            look_up(_integer_normals(), next_words(part.size).reshape(part.shape), part)
        sums = normals
        if window > 1:
            sums = new_image(padded, np.int32)
            cv2.boxFilter(normals, cv2.CV_32S, (window, window), sums, anchor=(0, 0), normalize=False)
        image = new_image(shape, np.float32)
        np.multiply(sums[: shape[0], : shape[1]], np.float32(1.0 / (_UNIT * window)), out=image, dtype=np.float32)
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
