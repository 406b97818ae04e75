"""Noise of an image sensor: photons, read-out, dark current and differences of the pixels (EMVA standard 1288)."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.elementary_functions import power
from simkit.extend import RandomStream, Sensor
from simkit.sensors.cameras.random_pixels import look_up, normal_table, word_source
from simkit_realism.camera_light import Light, LightArtefact, light_levels

_FIXED = 0  # index of the pattern that all images share
_HOT_SHARE = 65536  # a random word selects the hot pixels


class ImageSensor(LightArtefact):
    """`<simkit:image_sensor>` of a camera: light becomes electrons, then numbers of a converter (EMVA 1288).

    White is `full_well`/g electrons, where g = 10^(`gain`/20) is the gain. A pixel of mean µ electrons has the variance
    µ + `read_noise`² electrons². Its number is a whole number of `bit_depth` bits. The variance of the numbers is thus
    K·(mean - dark) + K²·read_noise² + 1/12 with the system gain K = (2^bit_depth - 1)·g/full_well. Numbers below 0
    become 0.

    Args:
        params: the element, with
            `full_well` saturation capacity [e⁻], `gain` [dB], `read_noise` temporal dark noise [e⁻],
            `bit_depth` bits of the converter, `dark_current` [e⁻/s] with `exposure_time` [s],
            `prnu` photo response non-uniformity, a share of the signal, `dsnu` dark signal non-uniformity [e⁻],
            `hot_pixels` share of the pixels that are always white,
            `black_level` number of a pixel without light, a share of white.
        sensor: the camera.
    """

    elements = ("colour/image_sensor",)
    order: ClassVar[float] = -30.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.full_well = params.number("full_well", 10_000.0, minimum=1.0, maximum=1e9)
        self.gain = params.number("gain", 0.0, minimum=-60.0, maximum=120.0)
        self.read_noise = params.number("read_noise", 0.0, minimum=0.0, maximum=1e6)
        self.bit_depth = params.integer("bit_depth", 12, minimum=1, maximum=16)
        self.dark_current = params.number("dark_current", 0.0, minimum=0.0, maximum=1e9)
        self.exposure_time = params.number("exposure_time", 0.0, minimum=0.0, maximum=3600.0)
        self.prnu = params.number("prnu", 0.0, minimum=0.0, maximum=1.0)
        self.dsnu = params.number("dsnu", 0.0, minimum=0.0, maximum=1e6)
        self.hot_pixels = params.number("hot_pixels", 0.0, minimum=0.0, maximum=1.0)
        self.black_level = params.number("black_level", 0.0, minimum=0.0, maximum=0.5)
        self.white = self.full_well / power(10.0, self.gain / 20.0)
        if self.dark_current > 0 and not self.exposure_time > 0:
            message = "<dark_current> has no effect without an <exposure_time>"
            params.warning("SK-SENSOR-237", message, "add <exposure_time>, in seconds")

    def prepare(self) -> None:
        count = len(self.sensor.camera_models)
        names = ("pixels", "response", "offset", "hot")
        self._streams = [{name: self._camera_stream(name, n) for name in names} for n in range(count)]
        self._patterns: dict[tuple[int, str, tuple[int, ...]], Light] = {}

    def _camera_stream(self, name: str, camera: int) -> RandomStream:
        return self.stream(f"{name}/{camera}" if camera else name)

    def change(self, light: Light, index: int, camera: int) -> Light:
        electrons = light
        electrons *= np.float32(self.white)
        if self.prnu > 0:
            electrons *= self._pattern(camera, "response", light.shape, 1.0, self.prnu)
        dark = self.dark_current * self.exposure_time
        if dark > 0:
            electrons += np.float32(dark)
        noise = _normal(self._streams[camera]["pixels"], index, light.shape)
        deviations = electrons + np.float32(self.read_noise * self.read_noise)
        noise *= np.sqrt(np.maximum(deviations, 0.0, out=deviations), out=deviations)
        electrons += noise
        if self.dsnu > 0:
            electrons += self._pattern(camera, "offset", light.shape, 0.0, self.dsnu)
        electrons *= np.float32(1.0 / self.white)
        if self.black_level > 0:
            electrons += np.float32(self.black_level)
        levels = 2**self.bit_depth - 1
        numbers = light_levels(electrons, levels)
        numbers *= np.float32(1.0 / levels)
        if self.hot_pixels > 0:
            words = word_source(self._streams[camera]["hot"], _FIXED)(numbers.size).reshape(light.shape)
            numbers[words < self.hot_pixels * _HOT_SHARE] = 1.0
        return numbers

    def _pattern(self, camera: int, name: str, shape: tuple[int, ...], mean: float, stddev: float) -> Light:
        """Return a pattern of all images of a camera, a normal number for each pixel."""
        key = camera, name, shape
        if key not in self._patterns:
            normal = _normal(self._streams[camera][name], _FIXED, shape)
            self._patterns[key] = normal * np.float32(stddev) + np.float32(mean)
        return self._patterns[key]


def _normal(stream: RandomStream, index: int, shape: tuple[int, ...]) -> npt.NDArray[np.float32]:
    """Return standard normal numbers for the values of an image."""
    out = np.empty(shape, np.float32)
    look_up(_table(), word_source(stream, index)(out.size).reshape(shape), out)
    return out


def _table() -> npt.NDArray[np.float32]:
    return normal_table().astype(np.float32)
