"""Readings of cameras, and their Gaussian noise, drawn from tables."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.elementary_functions import power
from simkit.runtime.engine.random_streams import RandomStreams
from simkit.sensors.cameras.array_pool import AnyArray, ArrayPool
from simkit.sensors.cameras.random_pixels import look_up, normal_table, word_source
from simkit.sensors.noise import NoiseModel


@dataclass(frozen=True)
class CameraReading:
    """Colours (h, w, 3), or brightness (h, w); depths (h, w) along the optical axis [m], None for a plain camera.

    Attributes:
        geoms: geom that each pixel shows, shape (h, w), -1 for none; None if no artefact reads it.
    """

    colours: npt.NDArray[np.uint8]
    depths: npt.NDArray[np.float32] | None
    geoms: npt.NDArray[np.int32] | None = None


class ChangedReading:
    """Reading of a camera whose colours or depths an artefact changes when they are first read.

    Args:
        previous: reading before the change.
        change_colours: function from the previous colours to the changed ones; None keeps them.
        change_depths: function from the previous depths to the changed ones; None keeps them.
    """

    def __init__(
        self,
        previous: CameraReading,
        change_colours: Callable[[AnyArray], AnyArray] | None = None,
        change_depths: Callable[[AnyArray], AnyArray] | None = None,
    ) -> None:
        self._previous, self._change_colours, self._change_depths = previous, change_colours, change_depths

    @functools.cached_property
    def colours(self) -> npt.NDArray[np.uint8]:
        """Colours (h, w, 3), or brightness (h, w)."""
        colours = self._previous.colours
        return colours if self._change_colours is None or not colours.size else self._change_colours(colours)

    @functools.cached_property
    def depths(self) -> npt.NDArray[np.float32] | None:
        """Depths (h, w) along the optical axis [m], None for a plain camera."""
        depths = self._previous.depths
        return depths if self._change_depths is None or depths is None else self._change_depths(depths)

    def __reduce__(self) -> tuple[object, ...]:
        return DrawnReading, (self.colours, self.depths, getattr(self._previous, "true_depths", None))


class NoisyCameraReading:
    """Reading with noise on its colours, which is drawn when the colours are first read."""

    def __init__(self, picture: CameraReading, noise: ImageNoise, index: int) -> None:
        self._picture, self._noise, self._index = picture, noise, index
        self._colours: npt.NDArray[np.uint8] | None = None

    @property
    def colours(self) -> npt.NDArray[np.uint8]:
        if self._colours is None:
            self._colours = self._noise.on_colours(self._picture.colours, self._index)
        return self._colours

    def __reduce__(self) -> tuple[object, ...]:
        depths, true_depths = (getattr(self, name, None) for name in ("depths", "true_depths"))
        picture = self._picture.colours
        return DrawnReading, (self.colours if picture.size else picture, depths, true_depths)


@dataclass(frozen=True)
class DrawnReading:
    """Reading whose noise is drawn already, as a pickled snapshot has it; depths are None for a plain camera."""

    colours: npt.NDArray[np.uint8]
    depths: npt.NDArray[np.float32] | None
    true_depths: npt.NDArray[np.float32] | None


_LONGEST = 1e30  # [m] limit of the noise of a 32-bit depth
# number of pixels processed at once: so few fit into a processor's cache, and OpenCV uses one thread for them
_PIXELS = 1 << 16
_MIDDLE = 128  # value for "no change" in a table that contains both increases and decreases
_OGRE_EXPONENT = 2.1


class ImageNoise:
    """Noise of one camera. The class is thread-safe.

    Args:
        model: white noise, in units of the full range (1 is white) for colours, in metres for depths.
        streams: random streams of the simulation.
        scoped: scoped name of the sensor.
        as_ogre: True distorts the noise of colours as Gazebo's renderer does: z → sign(z)·|z|^2.1, which removes most
            noise of common amounts (gz-rendering's shader `gaussian_noise_fs.glsl`).
    """

    def __init__(self, model: NoiseModel, streams: RandomStreams, scoped: str, *, as_ogre: bool = False) -> None:
        self._model, self._as_ogre = model, as_ogre
        self._streams = {channel: streams.stream(scoped, channel) for channel in ("image", "depth")}
        self._spares: dict[tuple[tuple[int, ...], str], ArrayPool] = {}
        self._own = threading.local()
        self.is_silent = model.stddev == 0 and model.mean == 0

    def _strips(
        self, channel: str, index: int, shape: tuple[int, ...]
    ) -> Iterator[tuple[slice, npt.NDArray[np.uint16]]]:
        """Yield the rows of an image, strip by strip, with a random word for each of their pixels."""
        height, width = shape[:2]
        next_words = word_source(self._streams[channel], index)
        for first in range(0, height, _strip_height(width)):
            last = min(first + _strip_height(width), height)
            count = (last - first) * width
            if self._model.stddev > 0:
                words = next_words(count)
            else:
                words = np.zeros(count, np.uint16)  # all values of the table are equal
            yield slice(first, last), words.reshape(last - first, width)

    def _brightness_changes(self, shape: tuple[int, ...]) -> _BrightnessChanges:
        """Return this thread's buffers, kept between images because fresh memory takes longer than the work."""
        changes_by_shape: dict[tuple[int, ...], _BrightnessChanges] = vars(self._own).setdefault("changes", {})
        if shape not in changes_by_shape:
            changes_by_shape[shape] = _BrightnessChanges(self._step_tables, shape)
        return changes_by_shape[shape]

    def _output_buffer(self, like: AnyArray) -> AnyArray:
        """Return an array for the result."""
        key = like.shape, like.dtype.str
        if key not in self._spares:
            self._spares[key] = ArrayPool(like.shape, like.dtype)
        return self._spares[key].take()

    def _draw_noise(self) -> npt.NDArray[np.float64]:
        """Return the noise of each random word."""
        return normal_table() * self._model.stddev + self._model.mean

    @functools.cached_property
    def _step_tables(self) -> tuple[npt.NDArray[np.uint8], ...]:
        """Tables from a random word to the change of a byte.

        If all changes fit into one table, 128 means no change. Otherwise one table has the increases and one has the
        decreases.
        """
        noise = self._draw_noise()
        if self._as_ogre:
            noise = np.sign(noise) * power(np.abs(noise), _OGRE_EXPONENT)
        # rounding before the addition is exact, because the pixels are integers
        levels = np.clip(np.rint(noise * 255.0), -255, 255)
        if levels[0] >= -_MIDDLE and levels[-1] < _MIDDLE:
            return ((levels + _MIDDLE).astype(np.uint8),)
        return np.clip(levels, 0, 255).astype(np.uint8), np.clip(-levels, 0, 255).astype(np.uint8)

    @functools.cached_property
    def _length_table(self) -> npt.NDArray[np.float32]:
        """Table from a random word to the change of a depth [m]."""
        return np.clip(self._draw_noise(), -_LONGEST, _LONGEST).astype(np.float32)

    def on_colours(self, picture: npt.NDArray[np.uint8], index: int) -> npt.NDArray[np.uint8]:
        """Return an image, shape (h, w) or (h, w, 3), with one draw per pixel for all channels, clipped to 0..255."""
        import cv2

        picture = np.ascontiguousarray(picture)
        out = self._output_buffer(picture)
        changes = self._brightness_changes(picture.shape)
        for rows, words in self._strips("image", index, picture.shape):
            part, (brighter, darker) = out[rows], changes.of(words)
            cv2.add(picture[rows], changes.widened(brighter), part)
            cv2.subtract(part, changes.widened(darker), part)
        return out

    def on_depths(self, depths: npt.NDArray[np.float32], index: int) -> npt.NDArray[np.float32]:
        """Return depths [m], shape (h, w), with one draw per pixel; infinite depths stay infinite."""
        out = self._output_buffer(depths)
        for rows, words in self._strips("depth", index, depths.shape):
            part = out[rows]
            look_up(self._length_table, words, part)
            np.add(part, depths[rows], out=part)
        return out


class _BrightnessChanges:
    """Increase and decrease of brightness for a strip of random words at a time.

    Args:
        steps: one table around 128, or two tables.
        shape: shape of the image.
    """

    def __init__(self, steps: tuple[npt.NDArray[np.uint8], ...], shape: tuple[int, ...]) -> None:
        size = min(_strip_height(shape[1]), shape[0]), shape[1]
        self._steps = steps
        self._flat = [np.empty(size, np.uint8) for _ in range(2)]
        self._middle = np.full(size, _MIDDLE, np.uint8)
        self._wide = np.empty((*size, 3), np.uint8) if len(shape) == 3 else None

    def of(self, words: npt.NDArray[np.uint16]) -> list[npt.NDArray[np.uint8]]:
        """Return two arrays like the words, as views of buffers that the next call overwrites."""
        import cv2

        count = len(words)
        up, down = (flat[:count] for flat in self._flat)
        look_up(self._steps[-1], words, down)
        if len(self._steps) == 2:
            look_up(self._steps[0], words, up)
        else:
            middle = self._middle[:count]
            cv2.subtract(down, middle, up)
            cv2.subtract(middle, down, down)
        return [up, down]

    def widened(self, change: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """Return a change for all channels of the image, in a buffer that the next call overwrites."""
        if self._wide is None:
            return change
        import cv2

        wide = self._wide[: len(change)]
        cv2.cvtColor(change, cv2.COLOR_GRAY2RGB, wide)
        return wide


def _strip_height(width: int) -> int:
    """Return the height of a strip, a multiple of four because random words come in fours."""
    return max(4, _PIXELS // width // 4 * 4)
