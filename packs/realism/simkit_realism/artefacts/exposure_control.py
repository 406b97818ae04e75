"""Exposure of colour cameras: a fixed exposure value, or a control that keeps the brightness of the image."""

from __future__ import annotations

from functools import partial
from typing import Any, ClassVar

import numpy as np

from simkit import Params
from simkit.elementary_functions import exp, log2, power
from simkit.extend import Artefact, Sensor
from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.tone_curve import WHITE, light_table
from simkit_realism.camera_light import Light, LightReading

_MODES = ("fixed", "auto")


class ExposureControl(Artefact):
    """`<simkit:exposure_control>` of a camera: the light of all pixels is multiplied by 2^EV.

    With the mode `auto`, the exposure value of a sample follows the mean light m of the newest earlier image without
    noise: EV += (log2(target/m) - EV)·(1 - exp(-1/time_constant)). A control thus reads each image of the camera, so
    that each is drawn, and the result does not depend on readers.

    Args:
        params: the element, with the `mode`, the `exposure_value` (EV, of the first image with `auto`), the
            `target`, a mean light from 0 to 1, the `time_constant` in images, and the limits `min_exposure_value` and
            `max_exposure_value`.
        sensor: the camera.

    Attributes:
        state: exposure value of the newest sample.
    """

    elements = ("colour/exposure_control",)
    order: ClassVar[float] = -40.0
    sensor: RenderedCamera

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.mode = params.choice("mode", _MODES, "fixed")
        self.start = params.number("exposure_value", 0.0, minimum=-20.0, maximum=20.0)
        self.target = params.number("target", 0.18, minimum=1e-4, maximum=1.0)
        self.time_constant = params.number("time_constant", 3.0, minimum=0.0)
        self.lowest = params.number("min_exposure_value", -8.0, minimum=-20.0, maximum=20.0)
        self.highest = params.number("max_exposure_value", 8.0, minimum=-20.0, maximum=20.0)
        if self.highest < self.lowest:
            message = f"found exposure values from {self.lowest:g} to {self.highest:g}"
            params.error("SK-SENSOR-236", message, "a <max_exposure_value> of at least the <min_exposure_value>")
            self.highest = self.lowest
        self._gain = 1.0 - exp(-1.0 / self.time_constant) if self.time_constant > 0 else 1.0
        self.state: Any = self.start

    def prepare(self) -> None:
        if self.mode == "auto":
            self.sensor.register_noise(self)

    @property
    def evolves(self) -> bool:
        return self.mode == "auto"

    def evolve(self, index: int, dt: float) -> None:
        """Adapt the exposure value to the newest image; `dt` has no effect, because the time constant is in images."""
        pictures = self.sensor.true_colours()
        if not pictures:
            return
        counts = np.zeros(256, np.int64)
        for colours in pictures:
            counts += np.bincount(colours.ravel(), minlength=256)
        total = int(counts.sum())
        if not total:
            return
        light = int((counts * light_table()).sum())
        goal = log2(self.target * WHITE * total / light) if light else self.highest
        value = self.state + (goal - self.state) * self._gain
        self.state = min(max(value, self.lowest), self.highest)

    def restart(self) -> None:
        self.state = min(max(self.start, self.lowest), self.highest) if self.mode == "auto" else self.start

    def set_interval(self, interval: float) -> None:
        """Accept the time between samples [s], which has no effect."""

    def apply(self, reading: Any, truth: Any, index: int) -> Any:
        # the factor is that of this sample, because the colours may be computed after later samples
        factor = np.float32(power(2.0, self.state))
        if isinstance(reading, tuple):
            return tuple(LightReading(picture, partial(_scale, factor)) for picture in reading)
        return LightReading(reading, partial(_scale, factor))


def _scale(factor: np.float32, light: Light) -> Light:
    light *= factor
    return light
