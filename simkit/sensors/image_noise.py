"""Gaussian noise on pictures: fresh for every pixel of every frame, by 16-bit random words and a table."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit.sensors.noise import NoiseModel

if TYPE_CHECKING:
    from simkit.runtime.random import RandomStreams

_WORDS = 1 << 16
_LONGEST = 1e30  # [m] of a depth's noise, which has 32 bits


@functools.cache
def _normal_table() -> npt.NDArray[np.float64]:
    """The standard normal's value in the middle of each of 65536 equally likely slices, scaled to variance 1."""
    from statistics import NormalDist

    upper = [NormalDist().inv_cdf((i + 0.5) / _WORDS) for i in range(_WORDS // 2, _WORDS)]
    table = np.concatenate((-np.array(upper[::-1]), upper))
    table /= table.std()
    return table


def _look_up(table: npt.NDArray[Any], words: npt.NDArray[np.uint16]) -> Any:
    """`table[words]`; OpenCV from version 5 on does it three times as fast."""
    import cv2

    return cv2.LUT(words, table) if int(cv2.__version__.split(".")[0]) >= 5 else table.take(words)


class ImageNoise:
    """Noise of one camera.

    Args:
        model: in units of the full range (1 is white) for colours, in metres for depth; white noise only.
        streams: the simulation's.
        scoped: the sensor's name.
    """

    def __init__(self, model: NoiseModel, streams: RandomStreams, scoped: str) -> None:
        self._model, self._streams, self._scoped = model, streams, scoped
        self.is_silent = model.stddev == 0 and model.mean == 0
        self._steps: Any = None
        self._lengths: Any = None

    def _words(self, channel: str, index: int, count: int) -> npt.NDArray[np.uint16]:
        # a generator of its own per frame, so that what was drawn before does not matter; the fastest one for the bulk
        key: Any = self._streams.words(self._scoped, channel, index).bit_generator
        bits: Any = np.random.SFC64(np.random.SeedSequence(key.random_raw(2).tolist()))
        words: npt.NDArray[np.uint16] = bits.random_raw(-(-count // 4)).view(np.uint16)[:count]
        return words

    def on_colours(self, picture: npt.NDArray[np.uint8], index: int) -> npt.NDArray[np.uint8]:
        """A picture, shape (h, w) or (h, w, 3), with one draw per pixel for all its channels, clipped to 0..255."""
        import cv2

        if self._steps is None:
            # rounding first is exact, since what it is added to is whole
            levels = np.rint((_normal_table() * self._model.stddev + self._model.mean) * 255.0)
            self._steps = np.clip(levels, 0, 255).astype(np.uint8), np.clip(-levels, 0, 255).astype(np.uint8)
        shape = picture.shape[:2]
        if self._model.stddev > 0:
            words = self._words("image", index, shape[0] * shape[1])
            brighter, darker = (_look_up(steps, words.reshape(shape)) for steps in self._steps)
        else:
            brighter, darker = (np.full(shape, steps[0]) for steps in self._steps)
        if picture.ndim == 3:
            brighter, darker = (cv2.cvtColor(step, cv2.COLOR_GRAY2RGB) for step in (brighter, darker))
        return np.asarray(cv2.subtract(cv2.add(picture, brighter), darker), dtype=np.uint8)

    def on_depths(self, depths: npt.NDArray[np.float32], index: int) -> npt.NDArray[np.float32]:
        """Depths [m], shape (h, w), with a draw per pixel; infinite ones stay."""
        if self._lengths is None:
            lengths = _normal_table() * self._model.stddev + self._model.mean
            self._lengths = np.clip(lengths, -_LONGEST, _LONGEST).astype(np.float32)
        if self._model.stddev == 0:
            shifted: npt.NDArray[np.float32] = depths + self._lengths[0]
            return shifted
        out: npt.NDArray[np.float32] = _look_up(
            self._lengths, self._words("depth", index, depths.size).reshape(depths.shape)
        )
        out += depths
        return out
