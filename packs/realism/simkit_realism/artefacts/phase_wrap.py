"""Wrap-around of a time-of-flight camera: distances beyond its unambiguous range begin again at zero."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from simkit import Params
from simkit.extend import Sensor
from simkit.sensors.cameras.camera_model import CameraModel
from simkit_realism.depth_images.depth_artefact import DepthArtefact, Depths, Exposure, PerModel


class PhaseWrap(DepthArtefact):
    """`<simkit:phase_wrap>` of a time-of-flight camera: the distance along the ray is known up to whole ranges.

    A camera that modulates its light with the frequency F has the range c/(2·F). The camera's `<clip>` must reach
    beyond this range, because it decides which surfaces send light back.

    Args:
        params: the element.
        sensor: the camera.
    """

    elements = ("depth/phase_wrap",)
    order = -3.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._range = params.number("range", required=True, minimum=0.01, maximum=1e6)
        self._stretch = PerModel(_stretch)

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        stretch = self._stretch.of(exposure.model)
        distances = depths.astype(np.float64) * stretch
        is_beyond = np.isfinite(distances) & (distances >= self._range)
        changed = depths.copy()
        wrapped = np.fmod(distances[is_beyond], self._range)  # fmod has no rounding error
        changed[is_beyond] = (wrapped / stretch[is_beyond]).astype(np.float32)
        return self.sensor.limit_depths(changed)


def _stretch(model: CameraModel) -> npt.NDArray[np.float64]:
    """Return the ratio of distance to depth at each pixel, shape (h, w)."""
    left, up = model.rays()
    up = up if up.ndim == 2 else up[:, None]
    stretch: npt.NDArray[np.float64] = np.sqrt(1.0 + left.astype(np.float64) ** 2 + up.astype(np.float64) ** 2)
    return stretch
