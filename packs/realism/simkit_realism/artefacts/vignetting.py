"""Vignetting: images are darker towards their corners."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from simkit import Params
from simkit.extend import Sensor
from simkit.sensors.cameras.camera_model import CameraModel
from simkit_realism.camera_light import Light, LightArtefact

_LAWS = ("cos4", "polynomial")


class Vignetting(LightArtefact):
    """`<simkit:vignetting>` of a camera: less light away from the optical axis.

    Args:
        params: the element, with the `law`. `cos4` is the illumination of a thin lens, cos⁴ of the angle to the optical
            axis. `polynomial` is 1 + a·ρ² + b·ρ⁴ + c·ρ⁶ with `coefficients` a b c, where ρ is the distance from the
            principal point as a share of half the diagonal of the image.
        sensor: the camera.
    """

    elements = ("colour/vignetting",)
    order: ClassVar[float] = -50.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self.coefficients = params.vector3("coefficients", (0.0, 0.0, 0.0))
        default = "polynomial" if params.has("coefficients") else "cos4"
        self.law = params.choice("law", _LAWS, default)
        self._maps: dict[CameraModel, Light] = {}
        if self.law == "cos4" and sensor.kind.replace("_", "") == "wideanglecamera":
            message = "<law>cos4</law> is the law of a pinhole camera, and this sensor is a wide_angle_camera"
            params.error("SK-SENSOR-235", message, "give the <coefficients> of a polynomial")
            self.law = "polynomial"

    def change(self, light: Light, index: int, camera: int) -> Light:
        share = self._share(self.sensor.camera_models[camera])
        light *= share if light.ndim == 2 else share[..., None]
        return light

    def _share(self, model: CameraModel) -> Light:
        """Return the share of the light that reaches each pixel, shape (h, w)."""
        if model not in self._maps:
            self._maps = {model: self._make_share(model), **dict(list(self._maps.items())[:7])}
        return self._maps[model]

    def _make_share(self, model: CameraModel) -> Light:
        if self.law == "cos4":
            x, y = model.directions()
            square = 1.0 + x * x + y * y
            share = 1.0 / (square * square)
        else:
            across, down = np.arange(model.width) + 0.5 - model.cx, np.arange(model.height) + 0.5 - model.cy
            half = 0.25 * (model.width * model.width + model.height * model.height)
            square = (across * across + (down * down)[:, None]) / half
            a, b, c = self.coefficients
            share = 1.0 + square * (a + square * (b + square * c))
        return np.nan_to_num(np.maximum(share, 0.0)).astype(np.float32)  # NaN where the lens shows nothing
