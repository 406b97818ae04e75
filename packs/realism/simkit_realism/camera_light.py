"""Readings of cameras in linear light, which artefacts of colour cameras change one after the other."""

from __future__ import annotations

import abc
from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit.extend import Artefact, CameraReading, ChangedReading
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.tone_curve import WHITE, colour_table, light_table

Bytes = npt.NDArray[np.uint8]
Light = npt.NDArray[np.float32]
Encoder = Callable[[Light], Bytes]


def decode(colours: Bytes) -> Light:
    """Return the linear light of colours, 1 for white; the colours follow sRGB."""
    return light_table().take(colours).astype(np.float32) * np.float32(1.0 / WHITE)


def encode(light: Light) -> Bytes:
    """Return the colours of linear light by sRGB; light beyond white is white."""
    return colour_table().take(light_levels(light, WHITE).astype(np.uint16))


def light_levels(light: Light, levels: int) -> Light:
    """Return light as whole numbers from 0 to `levels`, which is white."""
    numbers = light * np.float32(levels)
    np.rint(numbers, out=numbers)
    return np.clip(numbers, 0.0, levels, out=numbers)


class LightReading(ChangedReading):
    """Reading of a camera whose light an artefact changes when the colours are first read.

    Args:
        source: reading before the artefact.
        change: function that returns the light (h, w) or (h, w, 3) with the artefact; it may modify its argument.
        encoder: function from light to colours.
    """

    def __init__(self, source: CameraReading, change: Callable[[Light], Light], encoder: Encoder = encode) -> None:
        super().__init__(source)
        self._source, self._change, self._encoder = source, change, encoder

    @property
    def light(self) -> Light:
        """Linear light, 1 for white, in an array that nobody else has."""
        source = self._source
        return self._change(source.light if isinstance(source, LightReading) else decode(source.colours))

    @cached_property
    def colours(self) -> Bytes:
        """Colours (h, w, 3), or brightness (h, w)."""
        return self._encoder(self.light)


class LightArtefact(Artefact):
    """Base class of the artefacts of colour cameras: a change of the linear light of each camera of a sensor.

    Attributes:
        encoder: function from light to colours, if no later artefact changes the light.
    """

    order = -10.0
    sensor: RenderedCamera
    encoder: Encoder = staticmethod(encode)

    @abc.abstractmethod
    def change(self, light: Light, index: int, camera: int) -> Light:
        """Return the light with the artefact.

        Args:
            light: light (h, w), or (h, w, 3), 1 for white; it may be modified.
            index: number of the sample; the first is 1.
            camera: number of the camera in the sensor, from 0.
        """

    def apply(self, reading: Any, truth: Any, index: int) -> Any:
        if isinstance(reading, tuple):
            return tuple(self._on_camera(picture, index, n) for n, picture in enumerate(reading))
        return self._on_camera(reading, index, 0)

    def _on_camera(self, reading: CameraReading, index: int, camera: int) -> LightReading:
        return LightReading(reading, partial(self.change, index=index, camera=camera), self.encoder)
