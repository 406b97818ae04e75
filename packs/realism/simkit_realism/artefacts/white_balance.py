"""White balance error: gains of the colour channels."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from simkit import Params
from simkit.extend import Sensor
from simkit_realism.camera_light import Light, LightArtefact


class WhiteBalance(LightArtefact):
    """`<simkit:white_balance>` of a camera: gains of the channels, which make grey surfaces coloured.

    Args:
        params: the element, with `gains` of red, green and blue light.
        sensor: the camera.
    """

    elements = ("colour/white_balance",)
    order: ClassVar[float] = -20.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.gains = params.vector3("gains", (1.0, 1.0, 1.0))
        if min(self.gains) < 0:
            params.error(
                "SK-SENSOR-238", f"found a negative gain in <gains>{params.text('gains')}</gains>", "gains ≥ 0"
            )

    def change(self, light: Light, index: int, camera: int) -> Light:
        if light.ndim == 3:  # a grey camera has no colour filters
            light *= np.array(self.gains, np.float32)
        return light
