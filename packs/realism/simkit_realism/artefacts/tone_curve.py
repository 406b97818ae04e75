"""Tone curve of a camera: from light to 8-bit colours."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from simkit import Params
from simkit.elementary_functions import power
from simkit.extend import Sensor
from simkit.sensors.cameras.tone_curve import WHITE
from simkit_realism.camera_light import Bytes, Light, LightArtefact, encode, light_levels

_TYPES = ("srgb", "linear", "gamma")


class ToneCurve(LightArtefact):
    """`<simkit:tone_curve>` of a camera: how the light of a pixel becomes a number from 0 to 255.

    Args:
        params: the element, with the `type` (`srgb`; `linear`, as machine vision cameras have it; `gamma`, a power of
            1/`gamma`).
        sensor: the camera.
    """

    elements = ("colour/tone_curve",)
    order: ClassVar[float] = -10.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.type = params.choice("type", _TYPES, "gamma" if params.has("gamma") else "srgb")
        gamma = params.number("gamma", 2.2, minimum=0.1, maximum=10.0)
        exponent = 1.0 / gamma if self.type == "gamma" else 1.0
        self._table: Bytes | None = None
        if self.type != "srgb":
            light = np.arange(WHITE + 1.0) / WHITE
            self._table = np.rint(np.asarray(power(light, exponent)) * 255.0).astype(np.uint8)
        self.encoder = self._encode

    def _encode(self, light: Light) -> Bytes:
        return encode(light) if self._table is None else self._table.take(light_levels(light, WHITE).astype(np.uint16))

    def change(self, light: Light, index: int, camera: int) -> Light:
        return light
