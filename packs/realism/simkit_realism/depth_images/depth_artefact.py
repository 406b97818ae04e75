"""Base class of the artefacts of depth cameras."""

from __future__ import annotations

import abc
import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from simkit.extend import Artefact, CameraReading, ChangedReading
from simkit.sensors.cameras.camera_model import CameraModel
from simkit.sensors.cameras.image_messages import grey
from simkit.sensors.cameras.rgbd_camera import RgbdCamera

Depths = npt.NDArray[np.float32]
Shades = npt.NDArray[np.uint8]
Value = TypeVar("Value")
NO_RETURN = np.float32(np.inf)
"""Depth of a pixel without a return; `<simkit:lost_depth>` replaces it at the end."""
_CONTRAST_WINDOW = 7  # [px] side of the square in which the contrast is measured


@dataclass(frozen=True, slots=True)
class Exposure:
    """Measurement without artefacts and noise, with the optics that it was drawn with.

    Attributes:
        truth: reading without artefacts and noise.
        index: number of the sample.
        model: optics.
    """

    truth: CameraReading
    index: int
    model: CameraModel

    @property
    def depths(self) -> Depths:
        """True depths [m], shape (h, w); +inf without a surface, -inf below the range."""
        assert self.truth.depths is not None
        return self.truth.depths

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of the image [px]."""
        return self.model.height, self.model.width

    @property
    def brightness(self) -> Shades:
        """Brightness of the drawn colours, shape (h, w); white is 255."""
        colours = self.truth.colours
        return colours if colours.ndim == 2 else grey(colours)

    @property
    def contrast(self) -> Shades:
        """Difference between the brightest and the darkest pixel around each pixel, shape (h, w)."""
        shades, square = self.brightness, np.ones((_CONTRAST_WINDOW, _CONTRAST_WINDOW), np.uint8)
        return np.asarray(cv2.subtract(cv2.dilate(shades, square), cv2.erode(shades, square)), np.uint8)


class DepthArtefact(Artefact):
    """Artefact of depth images, computed when the depths are first read, so that unread depths cost nothing."""

    sensor: RgbdCamera

    def apply(self, reading: CameraReading, truth: CameraReading, index: int) -> ChangedReading:
        exposure = Exposure(truth, index, self.sensor.options.model)
        return ChangedReading(reading, change_depths=functools.partial(self.change, exposure=exposure))

    @abc.abstractmethod
    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        """Return depths [m], shape (h, w), with the artefact, as a new array.

        Args:
            depths: depths before this artefact; +inf without a return, -inf below the range; never modified.
            exposure: measurement without artefacts and noise.
        """


class PerModel(Generic[Value]):
    """Value computed from the optics of a camera, and again after a zoom.

    Args:
        compute: function of the optics.
    """

    def __init__(self, compute: Callable[[CameraModel], Value]) -> None:
        self._compute = compute
        self._newest: tuple[CameraModel, Value] | None = None

    def of(self, model: CameraModel) -> Value:
        """Return the value for the optics."""
        newest = self._newest
        if newest is None or newest[0] is not model:
            newest = self._newest = model, self._compute(model)
        return newest[1]
